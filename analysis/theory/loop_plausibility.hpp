#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"

/// Loops that are allowed but that nobody would build on purpose.
namespace zerocount::theory {

/// Trials whose loops are examined at most, over all design points.
inline constexpr std::int64_t max_trials_doubted = 100;

/// A warning for each test that fails, at the design point where it fails worst:
///
///   - a phase margin below 20°
///   - a delay margin (phase margin over crossover frequency) below one sample
///   - a move beyond the pre-sliding range, by a step or a profile, by a loop that is unstable while it
///   slides
///
/// The margins are those of trial_loops(), at rest and, where moves reach it, while sliding; of integral
/// control alone those at k1 + k2, because it is meant to work up to criterion (6) or beyond. They come from
/// the first trials of each point; of very many points some are examined, evenly spread.
std::vector<std::string> doubtful_loops(const study::Study& study);

}  // namespace zerocount::theory
