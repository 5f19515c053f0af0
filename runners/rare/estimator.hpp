#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/basis/statistics/proportion.hpp"
#include "runners/rare/proposal.hpp"

namespace zerocount::rare {

/// Settings of multilevel splitting, which drives a population of trials step by step to larger values of a
/// score.
struct SplittingSettings {
  std::size_t score{0};  ///< Index in Trial::scores of the score that splitting drives towards larger values.
  /// Smallest probability of a level. Splitting ends without a failure if a level is less probable.
  double least{1e-11};
  std::int64_t first_number{0};  ///< Trial::number of the first trial that splitting runs.
};

/// Course of one run of multilevel splitting along a score.
struct ScoreSearch {
  std::size_t score{0};  ///< Index in Trial::scores of the score along which the run splits.
  bool reached{false};   ///< Whether splitting reached failures: enough trials of the last level fail.
  /// Estimated probability of a failure if `reached`, otherwise of a score above the last level. It has no
  /// bounds.
  double probability{1.0};
  int levels{0};
  std::int64_t trials{0};
};

struct SplittingResult {
  ScoreSearch search;
  std::vector<Trial> plain;    ///< Trials before the first level, drawn from their own distribution.
  std::vector<Trial> failing;  ///< Trials distributed approximately as the trials that fail.
  /// [level] Trials distributed approximately as trials above the level, starting with the first level.
  std::vector<std::vector<Trial>> above;
};

/// Multilevel splitting (subset simulation) towards larger values of one score.
///
///     particles = plain trials; P = 1
///     until enough particles fail, or P < least:
///       level = the score that a fifth of the particles exceed
///       P *= proportion of the particles above the level
///       replace the other particles by copies of those above
///       move each particle by three steps of a Markov chain that keeps the distribution above the level
///
/// A step proposes z' = √(1 − β²)·z + β·ξ with ξ standard normal. It is refused if the score falls below the
/// level. An unordered coordinate is kept, or drawn anew in one of five steps. The number of a trial is drawn
/// anew in every other step. Sources: Au and Beck, Estimation of small failure probabilities in high
/// dimensions by subset simulation, Probabilistic Engineering Mechanics 16 (2001); Papaioannou et al., MCMC
/// algorithms for subset simulation, ibid. 41 (2015).
/// @param go_on asked before each level; false ends without a result
SplittingResult split(const SplittingSettings& settings, const TrialSpace& space, const Simulation& simulate,
                      NumberSource& numbers, const std::function<bool()>& go_on);

/// State of an estimate, from which it can be resumed: the learned proposal, and the trials drawn from it.
struct EstimatorState {
  std::int64_t trials{0};  ///< Number of all trials that were run so far.
  /// Number of trials drawn from their own distribution (plain trials), in all phases of the estimate.
  std::int64_t plain_trials{0};
  std::int64_t plain_failures{0};  ///< Number of plain trials with at least one failed move.
  std::vector<ScoreSearch> searches;
  bool learned{false};        ///< Whether the proposal has been learned, so that trials can be drawn from it.
  std::int64_t searched{0};   ///< Number of attempts to learn a proposal that were interrupted.
  std::int64_t learnings{0};  ///< Number of proposals that were learned so far, one after another.
  Proposal proposal;
  /// Largest importance weight of a failed trial that the confidence bounds allow for. A heavier one makes
  /// the estimator learn a new proposal.
  double cap{0.0};
  std::vector<Trial> drawn;  ///< Trials drawn from the current proposal, without their scores.

  /// Number of the trials in `drawn` with at least one failed move.
  std::int64_t failures() const {
    return std::ranges::count_if(drawn, [](const Trial& trial) { return trial.failed > 0.0; });
  }
};

struct EstimatorSettings {
  TrialSpace space{};
  std::size_t scores{1};  ///< Number of scores of each trial (size of Trial::scores).
  double confidence{statistics::summary_confidence};
  /// Wanted ratio of the confidence bounds, high / low. The estimate ends when it is reached.
  double ratio{2.0};
  std::uint64_t seed{0};
};

/// Maximum number of trials drawn from a proposal. Each takes some hundred bytes of memory.
inline constexpr std::size_t max_drawn = 2'000'000;
/// Maximum number of possible values of a discrete draw at which trials are run to find values that fail. A
/// discrete draw with more values is left out of this.
inline constexpr std::int64_t max_tried_values = 100'000;

enum class EstimateStatus {
  estimated,   ///< The confidence bounds are as narrow as asked.
  no_failure,  ///< No score leads to a failure, and no trial drawn from its own distribution failed.
  /// Some failures lie where the proposal hardly draws, so that weights above EstimatorState::cap recur.
  not_covered,
  too_many,  ///< The bounds are still wider than asked after max_drawn trials.
  budget     ///< The budget of trials or time ended before the bounds were as narrow as asked.
};

struct ProbabilityEstimate {
  EstimateStatus status{EstimateStatus::budget};
  bool narrow{false};  ///< Whether the bounds from the drawn trials are as narrow as asked.
  /// Estimated probability that a move fails (expected proportion of failing moves), 0 to 1.
  double probability{0.0};
  /// Confidence bounds of the expected proportion of failing moves. If the status is `estimated`, they are as
  /// narrow as asked. Otherwise `high` is at least plain_high.
  statistics::ConfidenceInterval bounds{};
  /// Clopper–Pearson upper bound of the expected proportion of failing moves, from the plain trials alone,
  /// which are drawn from their own distribution. It needs no score.
  double plain_high{1.0};
};

/// Estimates the expected proportion of failing moves by importance sampling.
///
///     run plain trials
///     if few of them fail:                                   // learning
///       run trials at every value of each rare discrete draw, more at the worst ones
///       split() along each score, twice along the first
///     repeat:
///       proposal = pinned values + mixture fitted to the failures + a normal for each level of splitting
///       improve it by 1 to 8 rounds of its own draws
///       until the bounds are as narrow as asked:             // estimation
///         draw z from the proposal; add w(z)·failed(z)
///     until no failure has a weight above the cap; each time with a smaller part of the error probability
///
/// A discrete value is rare below a probability of 1 %; values at which failures are frequent are pinned
/// (PinnedValue). The normals of the levels keep failures that splitting lost on its way from large weights.
/// A tenth of the draws are from the trials' own distribution, so that the likelihood ratio w is at most 10;
/// the expectation of w·failed is the probability. The bounds are betting_bounds(), whose cap is twice
/// the 99.8 % quantile of the weights of failures, and at least twice the weight of each plain failure.
///
/// `low` always holds. `high` assumes that failures to which no score and no value of a discrete draw leads
/// are less probable than the failures that are found. If nothing can be learned, or learning did not help,
/// plain trials run to the end of the budget. Their bounds need no assumption.
///
/// @param state empty, or the state of an interrupted estimate, which is then resumed
/// @param go_on asked with the state between parts of some hundred or thousand trials; false ends the
/// estimate
ProbabilityEstimate estimate(EstimatorState& state, const EstimatorSettings& settings,
                             const Simulation& simulate,
                             const std::function<bool(const EstimatorState&)>& go_on);

/// Estimate of the probability from the trials that a state already holds. No trial is run.
ProbabilityEstimate answer_of(const EstimatorState& state, const EstimatorSettings& settings);

}  // namespace zerocount::rare
