#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "analysis/statistics/betting_bounds.hpp"
#include "runners/rare/estimator.hpp"

namespace zerocount::rare {
namespace {

constexpr double disagreement = 10.0;  // of splitting and the bounds

std::vector<double> positive_values(const EstimatorState& state) {
  std::vector<double> values;
  for (const WeightedTrial& trial : state.drawn) {
    if (trial.failed > 0.0) values.push_back(trial.weight * trial.failed);
  }
  return values;
}

/// Confidence of the bounds of one proposal: the error probabilities of all have the sum that is allowed. The
/// first has most of it, then the plain trials that follow a proposal of no use.
double confidence_of(const EstimatorState& state, double confidence) {
  const double part = state.learnings <= 1 ? 0.7
                      : state.proposal.is_natural()
                          ? 0.2
                          : 0.1 * std::ldexp(1.0, static_cast<int>(1 - state.learnings));
  return 1.0 - (1.0 - confidence) * part;
}

bool is_narrow(const statistics::ConfidenceInterval& bounds, double ratio) {
  return bounds.low > 0.0 && bounds.high <= ratio * bounds.low;
}

/// Whether splitting along the first score found failures of a far larger probability than the bounds allow,
/// each time that it found some. Along the others it may end with copies of a few failures, whose number says
/// little.
bool splitting_disagrees(const EstimatorState& state, double high) {
  const auto is_meant = [](const ScoreSearch& search) { return search.score == 0 && search.reached; };
  return std::ranges::any_of(state.searches, is_meant) &&
         std::ranges::none_of(state.searches, [&](const ScoreSearch& search) {
           return is_meant(search) && search.probability <= disagreement * high;
         });
}

}  // namespace

Estimate answer_of(const EstimatorState& state, const EstimatorSettings& settings) {
  Estimate answer;
  answer.plain_high =
      statistics::clopper_pearson(state.plain_failures, state.plain_trials, settings.confidence).high;
  answer.bounds = {0.0, answer.plain_high};
  if (!state.learned) return answer;
  const std::vector<double> values = positive_values(state);
  if (state.drawn.empty()) return answer;
  answer.bounds = statistics::betting_bounds(values, std::ssize(state.drawn), state.cap,
                                             confidence_of(state, settings.confidence));
  answer.probability =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(state.drawn.size());
  answer.bounds.high = std::min(answer.bounds.high, 1.0);
  const bool exceeds = std::ranges::any_of(values, [&](double value) { return value > state.cap; });
  answer.narrow = !exceeds && is_narrow(answer.bounds, settings.ratio);
  const bool natural = state.proposal.is_natural();
  if (exceeds || (!natural && answer.narrow && splitting_disagrees(state, answer.bounds.high))) {
    answer.status = EstimateStatus::not_covered;
  } else if (answer.narrow) {
    answer.status = EstimateStatus::estimated;
  } else if (natural && state.plain_failures == 0) {
    answer.status = EstimateStatus::no_failure;
  } else if (state.drawn.size() >= max_drawn) {
    answer.status = EstimateStatus::too_many;
  }
  if (answer.status != EstimateStatus::estimated)
    answer.bounds.high = std::max(answer.bounds.high, answer.plain_high);
  return answer;
}

}  // namespace zerocount::rare
