#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

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

}  // namespace zerocount::rare
