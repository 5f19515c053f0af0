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
  std::size_t score{0};          ///< of Trial::scores, that is driven up
  double least{1e-11};           ///< ends without a failure where the probability of the level is below this
  std::int64_t first_number{0};  ///< of the trials
};

/// How splitting along a score went.
struct ScoreSearch {
  std::size_t score{0};
  bool reached{false};      ///< enough trials of the last level fail
  double probability{1.0};  ///< of the last level; of a failure if it was reached; without bounds
  int levels{0};
  std::int64_t trials{0};
};

struct SplittingResult {
  ScoreSearch search;
  std::vector<Trial> plain;    ///< of the first level, drawn from their own distribution
  std::vector<Trial> failing;  ///< approximately distributed as trials that fail
  /// [level] approximately distributed as trials above the level, from the first level on.
  std::vector<std::vector<Trial>> above;
};

/// Multilevel splitting (subset simulation) towards larger values of one score.
///
///     particles = plain trials; P = 1
///     until enough particles fail, or P < least:
///       level = the score that a fifth of the particles exceed
///       P *= proportion of the particles above it
///       replace the others by copies of those
///       move each particle by three steps of a Markov chain that keeps the distribution above the level
///
/// A step proposes z' = √(1 − β²)·z + β·ξ, ξ standard normal, and is refused where the score falls to the
/// level; an unordered coordinate is kept, or drawn anew in one of five steps. The number of a trial is drawn
/// anew in every other step. Sources: Au and Beck, Estimation of small failure probabilities in high
/// dimensions by subset simulation, Probabilistic Engineering Mechanics 16 (2001); Papaioannou et al., MCMC
/// algorithms for subset simulation, ibid. 41 (2015).
/// @param go_on asked before each level; false ends without a result
SplittingResult split(const SplittingSettings& settings, const TrialSpace& space, const Simulation& simulate,
                      NumberSource& numbers, const std::function<bool()>& go_on);

/// State of an estimate, from which it can go on: what has been learned, and the trials drawn since.
struct EstimatorState {
  std::int64_t trials{0};          ///< that were run, all together
  std::int64_t plain_trials{0};    ///< of these, trials drawn from their own distribution, in all phases
  std::int64_t plain_failures{0};  ///< of these, with a move that failed
  std::vector<ScoreSearch> searches;
  bool learned{false};        ///< the proposal is ready
  std::int64_t searched{0};   ///< learnings begun before this one that did not end
  std::int64_t learnings{0};  ///< how often a proposal was learned
  Proposal proposal;
  double cap{0.0};           ///< largest weight of a failure that the bounds allow for
  std::vector<Trial> drawn;  ///< from this proposal, without scores

  std::int64_t failures() const {  ///< of the drawn trials
    return std::ranges::count_if(drawn, [](const Trial& trial) { return trial.failed > 0.0; });
  }
};

struct EstimatorSettings {
  TrialSpace space{};
  std::size_t scores{1};
  double confidence{statistics::summary_confidence};
  double ratio{2.0};  ///< wanted of the bounds, high / low
  std::uint64_t seed{0};
};

/// Largest number of trials that are drawn from a proposal. One takes some hundred bytes.
inline constexpr std::size_t max_drawn = 2'000'000;
/// Largest number of values of a discrete draw that is tried value by value.
inline constexpr std::int64_t max_tried_values = 100'000;

enum class EstimateStatus {
  estimated,
  no_failure,   ///< no score leads to a failure, and no plain trial failed
  not_covered,  ///< failures keep having weights above the cap: the proposal hardly draws them
  too_many,     ///< the bounds are not narrow after as many trials as are kept
  budget        ///< ended before the bounds were narrow enough
};

struct Estimate {
  EstimateStatus status{EstimateStatus::budget};
  bool narrow{false};       ///< the bounds by the drawn trials are as narrow as asked
  double probability{0.0};  ///< expected proportion of failing moves
  /// As narrow as asked if it is estimated; otherwise `high` is not below that of the plain trials.
  statistics::ConfidenceInterval bounds{};
  /// Upper bound that needs no score: Clopper–Pearson, of the trials drawn from their own distribution.
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
/// the 99.8 % quantile of the weights of failures, and at least those of plain ones.
///
/// `low` always holds; `high` if the failures that no score, and no value of a discrete draw, leads to are
/// less probable than those that are found. Where nothing can be learned, or learning did not help, plain
/// trials go on to the end of the budget: their bounds need no premise.
///
/// @param state empty, or of an interrupted estimate, which then goes on
/// @param go_on asked between parts of some hundred or thousand trials, with the state; false ends it
Estimate estimate(EstimatorState& state, const EstimatorSettings& settings, const Simulation& simulate,
                  const std::function<bool(const EstimatorState&)>& go_on);

/// The answer as far as the state goes.
Estimate answer_of(const EstimatorState& state, const EstimatorSettings& settings);

}  // namespace zerocount::rare
