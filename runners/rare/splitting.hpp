#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "runners/rare/trial_point.hpp"

namespace zerocount::rare {

/// Settings of multilevel splitting.
struct SplittingSettings {
  std::size_t coordinates{0};
  std::vector<std::size_t> unordered{};  ///< TrialSpace::unordered
  std::size_t score{0};                  ///< of PointResult::scores, that is driven up
  std::size_t particles{600};            ///< trials of a level
  int steps{3};                          ///< of the Markov chain between two levels
  double least{1e-11};           ///< ends without a failure where the probability of the level is below this
  std::int64_t first_number{0};  ///< of the trials
};

/// The result of splitting along one score.
struct SplittingResult {
  bool reached{false};      ///< enough trials of the last level fail
  double probability{1.0};  ///< estimate of P of the last level, or of a failure; without bounds
  int levels{0};
  std::int64_t trials{0};
  std::int64_t plain_trials{0};           ///< of the first level, drawn from their own distribution
  std::vector<TrialPoint> plain_failing;  ///< plain trials with a move that failed
  std::vector<TrialPoint> failing;        ///< approximately distributed as trials that fail
  /// [level] approximately distributed as trials above the level, from the first level on.
  std::vector<std::vector<TrialPoint>> above;
};

/// Multilevel splitting (subset simulation) towards larger values of one score.
///
///     particles = plain trials; P = 1
///     until enough particles fail, or P < least:
///       level = the score that a fifth of the particles exceed
///       P *= proportion of the particles above it
///       replace the others by copies of those
///       move each particle by `steps` steps of a Markov chain that keeps the distribution above the level
///
/// A step proposes z' = √(1 − β²)·z + β·ξ, ξ standard normal, and is refused where the score falls to the
/// level; an unordered coordinate is kept, or drawn anew in one of five steps. The number of a trial is drawn
/// anew in every other step. Sources: Au and Beck, Estimation of small failure probabilities in high
/// dimensions by subset simulation, Probabilistic Engineering Mechanics 16 (2001); Papaioannou et al., MCMC
/// algorithms for subset simulation, ibid. 41 (2015).
/// @param go_on asked before each level; false ends without a result
SplittingResult split(const SplittingSettings& settings, const Simulation& simulate, NumberSource& numbers,
                      const std::function<bool()>& go_on);

}  // namespace zerocount::rare
