#include "analysis/summary/best_point.hpp"

#include <algorithm>

#include "analysis/statistics/clustered_proportion.hpp"
#include "analysis/statistics/confidence_sequence.hpp"
#include "analysis/statistics/rig_statistics.hpp"

namespace zerocount::summary {
namespace {

bool better(const measures::PointSummary& one, const measures::PointSummary& other) {
  if (one.outcomes.zero_count != other.outcomes.zero_count)
    return static_cast<double>(one.outcomes.zero_count) * static_cast<double>(other.trials) >
           static_cast<double>(other.outcomes.zero_count) * static_cast<double>(one.trials);
  return one.of(&trial::MoveOutcome::settling_time).median.value <
         other.of(&trial::MoveOutcome::settling_time).median.value;
}

}  // namespace

std::int64_t best_point(std::span<const measures::PointSummary> points) {
  std::size_t best = 0;
  for (std::size_t point = 1; point < points.size(); ++point) {
    if (better(points[point], points[best])) best = point;
  }
  return static_cast<std::int64_t>(best);
}

double confidence_of_each(double confidence, std::size_t points) {
  return 1.0 - (1.0 - confidence) / static_cast<double>(points);
}

statistics::SuccessClaim claim_of_chosen(const measures::PointSummary& point, std::size_t points,
                                         bool stopped) {
  const std::int64_t successes = point.claim.trials - point.claim.failures;
  const double confidence = confidence_of_each(point.claim.confidence, points);
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
  const double each = confidence_of_each(confidence, points);
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
