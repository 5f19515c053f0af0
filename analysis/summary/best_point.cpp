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

namespace zerocount::summary {
namespace {

/// Criteria for the best point, the most important first. Larger values are better.
using Merits = std::vector<double>;

/// A time not reached within the hold is later than any other.
double earliness(double time) {
  return std::isnan(time) ? -std::numeric_limits<double>::infinity() : -time;
}

Merits merits_without_goal(const measures::PointSummary& point) {
  return {statistics::rate(point.outcomes.zero_count, point.trials),
          earliness(point.of(&trial::MoveOutcome::settling_time).median.value)};
}

Merits merits_by_goal(const measures::PointSummary& point, const study::Goal& goal) {
  const goal::Verdict verdict = goal::judge_goal(goal, *point.goal, 1);
  return {goal.machines ? verdict.machines.value : 0.0, verdict.moves.value,
          earliness(measures::of_band(point, "band_settling_time", goal.band).p95.value)};
}

}  // namespace

std::int64_t best_point(std::span<const measures::PointSummary> points,
                        const std::optional<study::Goal>& goal) {
  std::size_t best = 0;
  Merits of_best;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].trials == 0) continue;  // of an unfinished run
    Merits merits =
        goal && points[i].goal ? merits_by_goal(points[i], *goal) : merits_without_goal(points[i]);
    if (!of_best.empty() && !(merits > of_best)) continue;
    best = i;
    of_best = std::move(merits);
  }
  return static_cast<std::int64_t>(best);
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
