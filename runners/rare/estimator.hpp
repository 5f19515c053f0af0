#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/statistics/proportion.hpp"
#include "runners/rare/proposal.hpp"
#include "runners/rare/trial_point.hpp"

namespace zerocount::rare {

/// A trial that was drawn from the proposal.
struct WeightedTrial {
  TrialPoint point;
  double weight{0.0};  ///< likelihood_ratio()
  double failed{0.0};  ///< proportion of its moves that fail
};

/// How splitting along a score went.
struct ScoreSearch {
  std::size_t score{0};
  bool reached{false};
  double probability{1.0};  ///< of the last level; of a failure if it was reached
  int levels{0};
  std::int64_t trials{0};
};

/// All that decides how an estimate goes on: what has been learned, and the trials drawn since.
struct EstimatorState {
  std::int64_t trials{0};          ///< that were run, all together
  std::int64_t plain_trials{0};    ///< of these, trials drawn from their own distribution, in all phases
  std::int64_t plain_failures{0};  ///< of these, with a move that failed
  std::vector<ScoreSearch> searches;
  bool learned{false};        ///< the proposal is ready
  std::int64_t searched{0};   ///< searches before this one, which did not end
  std::int64_t learnings{0};  ///< how often it was learned
  Proposal proposal;
  double cap{0.0};                   ///< no failure should have a larger weight
  std::vector<WeightedTrial> drawn;  ///< from this proposal
};

struct EstimatorSettings {
  TrialSpace space{};
  std::size_t scores{1};
  double confidence{0.95};
  double ratio{2.0};  ///< wanted of the bounds, high / low
  std::uint64_t seed{0};
};

/// Discrete draws with more values are not tried value by value.
inline constexpr std::int64_t max_tried_values = 100'000;

enum class EstimateStatus {
  estimated,
  no_failure,   ///< no score leads to a failure, and no plain trial failed
  not_covered,  ///< failures are found that the proposal does not foresee
  too_many,     ///< the bounds are not narrow after as many trials as are kept
  budget        ///< ended before the bounds were narrow enough
};

struct Estimate {
  EstimateStatus status{EstimateStatus::budget};
  bool narrow{false};  ///< the bounds by the drawn trials are as narrow as asked
  double probability{0.0};
  /// As narrow as asked if it is estimated; otherwise `high` is not below that of the plain trials.
  statistics::ConfidenceInterval bounds{};
  /// Upper bound that needs no score: Clopper–Pearson, of the trials drawn from their own distribution.
  double plain_high{1.0};
};

/// Estimates the expected proportion of failing moves by importance sampling.
///
/// Learning: plain trials; trials at every value of each discrete draw that has a probability below 1 %, and
/// more at those values that fail or have the largest scores; then splitting along each score, twice along
/// the first. Values at which failures are frequent become part of the proposal (PinnedValue). A mixture of
/// normal distributions is fitted to the other failures found, and one normal distribution to each level on
/// the way, so that failures which splitting lost on its way have no large weight. One to eight rounds of
/// draws from it improve the fit. Estimation: trials from the proposal, among them a tenth from their own
/// distribution, weighted by the likelihood ratio w ≤ 10: the expectation of w·failed is the probability. The
/// bounds are betting_bounds(), whose cap is twice the 99.8 % quantile of the weights of failures, and no
/// less than those of plain ones. Where a failure has a larger one, the proposal is learned again with it,
/// and the estimation begins anew with a smaller part of the error probability. So `low` always holds, and
/// `high` if the failures that no score, and no value of a discrete draw, leads to are less probable than
/// those that are found. Where nothing can be learned, or learning did not help, plain trials go on to the
/// end of the budget: their bounds need no premise.
///
/// @param state empty, or of an interrupted estimate, which then goes on
/// @param go_on asked between parts of some hundred or thousand trials, with the state; false ends it
Estimate estimate(EstimatorState& state, const EstimatorSettings& settings, const Simulation& simulate,
                  const std::function<bool(const EstimatorState&)>& go_on);

/// The answer as far as the state goes.
Estimate answer_of(const EstimatorState& state, const EstimatorSettings& settings);

}  // namespace zerocount::rare
