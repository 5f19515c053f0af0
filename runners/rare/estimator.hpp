#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/statistics/proportion.hpp"
#include "runners/rare/proposal.hpp"

namespace zerocount::rare {

/// Settings of multilevel splitting.
struct SplittingSettings {
  std::size_t score{0};  ///< Index in Trial::scores of the score that is driven up.
  double least{1e-11};   ///< Splitting ends without a failure if the probability of a level is below this.
  std::int64_t first_number{0};  ///< Trial::number of the first trial.
};

/// Course of splitting along a score.
struct ScoreSearch {
  std::size_t score{0};     ///< Index in Trial::scores.
  bool reached{false};      ///< Whether failures were reached: enough trials of the last level fail.
  double probability{1.0};  ///< Probability of a failure if reached, else of the last level; without bounds.
  int levels{0};
  std::int64_t trials{0};
};

struct SplittingResult {
  ScoreSearch search;
  std::vector<Trial> plain;    ///< Trials before the first level, drawn from their own distribution.
  std::vector<Trial> failing;  ///< Trials distributed approximately as trials that fail.
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
  std::int64_t trials{0};          ///< Number of all trials that were run.
  std::int64_t plain_trials{0};    ///< Number of trials drawn from their own distribution, in all phases.
  std::int64_t plain_failures{0};  ///< Number of plain trials with a failed move.
  std::vector<ScoreSearch> searches;
  bool learned{false};        ///< Whether the proposal is ready.
  std::int64_t searched{0};   ///< Number of earlier attempts to learn that did not end.
  std::int64_t learnings{0};  ///< Number of proposals learned so far.
  Proposal proposal;
  double cap{0.0};           ///< Largest weight of a failure that the bounds allow for.
  std::vector<Trial> drawn;  ///< Trials drawn from this proposal, without scores.

  /// Number of drawn trials with a failed move.
  std::int64_t failures() const {
    return std::ranges::count_if(drawn, [](const Trial& trial) { return trial.failed > 0.0; });
  }
};

struct EstimatorSettings {
  TrialSpace space{};
  std::size_t scores{1};  ///< Number of Trial::scores.
  double confidence{statistics::summary_confidence};
  double ratio{2.0};  ///< Wanted ratio of the bounds, high / low.
  std::uint64_t seed{0};
};

/// Maximum number of trials drawn from a proposal. Each takes some hundred bytes.
inline constexpr std::size_t max_drawn = 2'000'000;
/// Maximum number of values of a discrete draw for which each value is tried. Draws with more values are not
/// tried.
inline constexpr std::int64_t max_tried_values = 100'000;

enum class EstimateStatus {
  estimated,    ///< The bounds are as narrow as asked.
  no_failure,   ///< No score leads to a failure, and no plain trial failed.
  not_covered,  ///< The proposal hardly draws some failures: weights above the cap recur.
  too_many,     ///< The bounds are too wide after max_drawn trials.
  budget        ///< The budget ended before the bounds were narrow enough.
};

struct Estimate {
  EstimateStatus status{EstimateStatus::budget};
  bool narrow{false};       ///< Whether the bounds from the drawn trials are as narrow as asked.
  double probability{0.0};  ///< Estimate of the expected proportion of failing moves.
  /// Bounds of the expected proportion of failing moves. If the status is `estimated`, they are as narrow as
  /// asked. Otherwise `high` is at least plain_high.
  statistics::ConfidenceInterval bounds{};
  /// Clopper–Pearson upper bound from the plain trials alone, which are drawn from their own distribution. It
  /// needs no score.
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
Estimate estimate(EstimatorState& state, const EstimatorSettings& settings, const Simulation& simulate,
                  const std::function<bool(const EstimatorState&)>& go_on);

/// Estimate from the trials in a state, without running any.
Estimate answer_of(const EstimatorState& state, const EstimatorSettings& settings);

}  // namespace zerocount::rare
