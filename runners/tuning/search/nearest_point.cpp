#include "runners/tuning/search/nearest_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "analysis/parallel/parallel.hpp"
#include "analysis/statistics/spread_over.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t max_tried_points = 1024;

}  // namespace

bool keeps(const SmallestMargins& margins, const study::LoopMargins& wanted) {
  return margins.stable && margins.gain >= wanted.gain.value_or(margins.gain) &&
         margins.phase >= wanted.phase.value_or(margins.phase) &&
         margins.delay >= wanted.delay.value_or(margins.delay) &&
         margins.sensitivity <= wanted.sensitivity.value_or(margins.sensitivity);
}

std::optional<NearestPoint> nearest_point(
    std::span<const Values> tried, const LoopExaminer& examiner, const study::LoopMargins& wanted,
    const std::function<std::optional<study::Study>(const Values&)>& candidate, bool slides,
    const std::stop_token& stop) {
  std::vector<Values> points;
  for (const std::int64_t i : statistics::spread_over(std::ssize(tried), max_tried_points))
    points.push_back(tried[static_cast<std::size_t>(i)]);
  std::vector<double> shortfalls(points.size(), std::numeric_limits<double>::infinity());
  parallel::for_each_index(points.size(), [&](std::size_t i) {
    if (stop.stop_requested()) throw trial::Interrupted{};
    if (const std::optional<study::Study> study = candidate(points[i]))
      shortfalls[i] = examiner.shortfall(*study, wanted, slides);
  });
  const auto least = std::ranges::min_element(shortfalls);
  if (least == shortfalls.end() || std::isinf(*least)) return std::nullopt;
  const Values& values = points[static_cast<std::size_t>(least - shortfalls.begin())];
  return NearestPoint{values, examiner.margins_of(candidate(values).value(), slides, stop)};
}

}  // namespace zerocount::tuning
