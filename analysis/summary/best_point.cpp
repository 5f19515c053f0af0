#include "analysis/summary/best_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/statistics/clustered_proportion.hpp"
#include "analysis/statistics/confidence_sequence.hpp"
#include "analysis/statistics/rig_statistics.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::summary {
namespace {

/// Criteria for the best point, the most important first. Larger values are better.
using Merits = std::vector<double>;

/// A time not reached within the hold is later than any other.
double earliness(double time) {
  return std::isnan(time) ? -std::numeric_limits<double>::infinity() : -time;
}

/// Swept parameters of the point that are other than 0 or none: the fewer, the simpler.
std::int64_t parts_in_use(const StudySummary& summary, std::size_t point) {
  return std::ranges::count_if(summary.axes, [&](const study::SweepAxis& axis) {
    if (axis.kind != study::SweepAxis::Kind::number) return false;
    const auto row = parameters::find_parameter(axis.name);
    const double value = axis.numbers[point];
    return value != 0.0 && !(row && parameters::parameter_table()[*row].none == value);
  });
}

Merits merits_of(const StudySummary& summary, std::size_t index) {
  const measures::PointSummary& point = summary.points[index];
  if (summary.features.open_loop) return {};
  Merits merits;
  if (summary.goal && point.goal) {
    const goal::Verdict verdict = goal::judge_goal(*summary.goal, *point.goal, 1);
    if (summary.goal->machines) merits.push_back(verdict.machines.value);
    merits.push_back(verdict.moves.value);
    merits.push_back(earliness(measures::of_band(point, "band_settling_time", summary.goal->band).p95.value));
  } else {
    merits.push_back(statistics::rate(point.outcomes.zero_count, point.trials));
    merits.push_back(earliness(point.of(&trial::MoveOutcome::settling_time).median.value));
  }
  merits.push_back(-static_cast<double>(parts_in_use(summary, index)));
  return merits;
}

}  // namespace

std::vector<std::int64_t> points_by_merit(const StudySummary& summary) {
  std::vector<std::pair<Merits, std::int64_t>> points;
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    if (summary.points[i].trials > 0)
      points.emplace_back(merits_of(summary, i), static_cast<std::int64_t>(i));
  }
  std::ranges::stable_sort(points, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::int64_t> order;
  order.reserve(points.size());
  for (const auto& [merits, point] : points) order.push_back(point);
  return order;
}

std::int64_t best_point(const StudySummary& summary) {
  const std::vector<std::int64_t> order = points_by_merit(summary);
  return order.empty() ? 0 : order.front();
}

statistics::SuccessClaim claim_of_chosen(const measures::PointSummary& point, std::size_t points,
                                         bool stopped) {
  const std::int64_t successes = point.claim.trials - point.claim.failures;
  const double confidence = statistics::confidence_of_each(point.claim.confidence, points);
  statistics::SuccessClaim claim =
      stopped ? statistics::success_claim_at_any_time(successes, point.claim.trials, confidence)
              : statistics::success_claim(successes, point.claim.trials, confidence);
  if (point.rigs.n > 0) {
    const statistics::SuccessClaim over_rigs =
        statistics::success_claim_on_rigs(point.rigs.successes, confidence);
    claim = stopped ? statistics::weaker_claim(over_rigs, claim) : over_rigs;
  }
  claim.confidence = point.claim.confidence;
  return claim;
}

statistics::ConfidenceInterval bounds_of_chosen(const measures::PointSummary& point, std::size_t points,
                                                bool stopped, double confidence) {
  const double each = statistics::confidence_of_each(confidence, points);
  const statistics::ConfidenceInterval fixed =
      point.rigs.n > 0 ? statistics::clustered_proportion(point.rigs.successes, each).korn_graubard
                       : statistics::clopper_pearson(point.outcomes.zero_count, point.judged, each);
  if (!stopped) return fixed;
  const statistics::ConfidenceInterval sequential =
      statistics::confidence_sequence_bounds(point.outcomes.zero_count, point.judged, each);
  if (point.rigs.n == 0) return sequential;
  return {std::min(sequential.low, fixed.low), std::max(sequential.high, fixed.high)};
}

}  // namespace zerocount::summary
