#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "analysis/measures/move_counts.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::measures {

/// What is asked of a move: to be within an error band for good in time, or to succeed (end at zero counts).
struct CountedGoal {
  std::optional<std::size_t> slot{};  ///< of the band, in MoveOutcome::bands; nothing: the move succeeds
  double within{0.0};                 ///< s; of a band
};

/// The goal of the study as it is counted; nothing without one.
std::optional<CountedGoal> counted_goal(const study::Study& study);
/// The goal of the study, or success where it has none.
inline CountedGoal asked_of_moves(const study::Study& study) {
  return counted_goal(study).value_or(CountedGoal{});
}

/// The latest time in time, s: a sample at the very end is, although k·T may be rounded up.
inline double latest(const CountedGoal& goal) {
  constexpr double rounding = 1.0 + 1e-12;
  return goal.within * rounding;
}

/// When the error of the move is within the goal's band for good, or has arrived (of success), s; NaN if
/// never.
inline double settling_time(const CountedGoal& goal, const trial::MoveOutcome& move) {
  return goal.slot ? move.bands[*goal.slot].settling_time : move.settling_time;
}

/// Whether the move is within the goal's band for good in time, or succeeds.
inline bool meets(const CountedGoal& goal, const trial::MoveOutcome& move) {
  if (!goal.slot) return trial::is_success(move.outcome);
  return settling_time(goal, move) <= latest(goal);  // false for NaN
}

/// Adds the moves of a trial to those that meet the goal. @param rigs number of rigs; 0: no trials share a
/// rig
void count_moves(MoveCounts& counts, const CountedGoal& goal, std::int64_t trial, std::int64_t rigs,
                 std::span<const trial::MoveOutcome> moves);

}  // namespace zerocount::measures
