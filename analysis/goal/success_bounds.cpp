#include "analysis/goal/success_bounds.hpp"

#include <algorithm>
#include <cstdint>

#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/clusters/rig_statistics.hpp"
#include "analysis/statistics/confidence_sequence.hpp"

namespace zerocount::goal {

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

}  // namespace zerocount::goal
