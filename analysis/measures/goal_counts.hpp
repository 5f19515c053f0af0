#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "analysis/measures/move_counts.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::measures {

/// The goal of a study as the moves are counted by it.
struct CountedGoal {
  std::size_t slot{0};  ///< of its band, in MoveOutcome::bands
  double within{0.0};   ///< s
};

/// The goal of the study as it is counted; nothing without one.
std::optional<CountedGoal> counted_goal(const study::Study& study);

/// The latest time in time, s: a sample at the very end is, although k·T may be rounded up.
inline double latest(const CountedGoal& goal) {
  constexpr double rounding = 1.0 + 1e-12;
  return goal.within * rounding;
}

/// Whether the error of the move is within the goal's band for good in time.
inline bool meets(const CountedGoal& goal, const trial::MoveOutcome& move) {
  return move.bands[goal.slot].settling_time <= latest(goal);  // false for NaN
}

/// Adds the moves of a trial to those that meet the goal. @param rigs number of rigs; 0: no trials share a
/// rig
void count_moves(MoveCounts& counts, const CountedGoal& goal, std::int64_t trial, std::int64_t rigs,
                 std::span<const trial::MoveOutcome> moves);

}  // namespace zerocount::measures
