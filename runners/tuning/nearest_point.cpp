#include "runners/tuning/nearest_point.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "analysis/parallel/parallel.hpp"
#include "analysis/statistics/spread_over.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t max_tried_points = 1024;
constexpr std::int64_t max_unstable_points = 32;
constexpr int halvings = 7;

study::LoopMargins part_of(const study::LoopMargins& margins, double part) {
  study::LoopMargins scaled = margins;
  for (std::optional<double>* const one : {&scaled.gain, &scaled.phase, &scaled.delay}) {
    if (*one) **one *= part;
  }
  if (scaled.sensitivity) *scaled.sensitivity = 1.0 + (*scaled.sensitivity - 1.0) / part;  // from infinity
  return scaled;
}

class NearestSearch {
 public:
  NearestSearch(const LoopExaminer& examiner,
                const std::function<std::optional<study::Study>(const Values&)>& candidate, bool slides,
                const std::stop_token& stop)
      : examiner_(examiner), candidate_(candidate), slides_(slides), stop_(stop) {}

  /// The points whose critical machines keep these margins.
  std::vector<Values> that_keep(const std::vector<Values>& points, const study::LoopMargins& margins) const {
    std::vector<char> kept(points.size(), 0);
    parallel::for_each_index(points.size(), [&](std::size_t i) {
      if (stop_.stop_requested()) throw trial::Interrupted{};
      const std::optional<study::Study> study = candidate_(points[i]);
      kept[i] = study && examiner_.may_keep(*study, margins, slides_) ? 1 : 0;
    });
    std::vector<Values> found;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (kept[i] != 0) found.push_back(points[i]);
    }
    return found;
  }

  std::optional<NearestPoint> examined(const Values& values) const {
    const std::optional<study::Study> study = candidate_(values);
    if (!study) return std::nullopt;
    return NearestPoint{values, examiner_.margins_of(*study, slides_, stop_)};
  }

  /// Of unstable loops the gain margin is the change of the gain that makes them stable.
  std::optional<NearestPoint> least_unstable(const std::vector<Values>& points) const {
    std::optional<NearestPoint> nearest;
    for (const std::int64_t i : statistics::spread_over(std::ssize(points), max_unstable_points)) {
      std::optional<NearestPoint> one = examined(points[static_cast<std::size_t>(i)]);
      if (one && (!nearest || one->margins.gain < nearest->margins.gain)) nearest = std::move(one);
    }
    return nearest;
  }

 private:
  const LoopExaminer& examiner_;
  const std::function<std::optional<study::Study>(const Values&)>& candidate_;
  bool slides_;
  std::stop_token stop_;
};

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
  const NearestSearch search(examiner, candidate, slides, stop);
  std::vector<Values> points;
  for (const std::int64_t i : statistics::spread_over(std::ssize(tried), max_tried_points))
    points.push_back(tried[static_cast<std::size_t>(i)]);
  std::vector<Values> nearest = search.that_keep(points, part_of(wanted, 0.0));
  if (nearest.empty()) return search.least_unstable(points);
  double kept = 0.0;
  double lost = 1.0;
  for (int i = 0; i < halvings && nearest.size() > 1; ++i) {
    const double part = 0.5 * (kept + lost);
    std::vector<Values> found = search.that_keep(nearest, part_of(wanted, part));
    (found.empty() ? lost : kept) = part;
    if (!found.empty()) nearest = std::move(found);
  }
  return search.examined(nearest.front());
}

}  // namespace zerocount::tuning
