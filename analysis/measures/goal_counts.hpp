#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "analysis/measures/move_counts.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::measures {

/// A limit of a goal: the magnitude of this value of a move is at most `largest`.
struct CountedLimit {
  std::function<double(const trial::MoveOutcome&)> value{};
  double largest{0.0};
};

/// What is asked of a move: to be within an error band, or a tolerance, for good in time and to keep the
/// limits; or to succeed (end at zero counts).
struct CountedGoal {
  std::optional<std::size_t> slot{};       ///< of the band, in MoveOutcome::bands
  double within{0.0};                      ///< s; of a band or a tolerance
  std::optional<std::size_t> tolerance{};  ///< in MoveOutcome::tolerance_settling_times. Neither: it succeeds
  std::vector<std::int64_t> on{};          ///< the moves that are asked, rising; empty: all
  std::vector<CountedLimit> limits{};
};

/// The goal as moves with these features are counted; nothing where they lack its band, tolerance or limits.
std::optional<CountedGoal> counted_by(const study::Goal& goal, const study::StudyFeatures& features);
/// The goals of the study as they are counted, [goal]; empty without one.
std::vector<CountedGoal> counted_goals(const study::Study& study);
/// The goals of the study, or success where it has none.
std::vector<CountedGoal> asked_of_moves(const study::Study& study);

/// Number of moves of a trial that the goal asks. @param moves of a trial
inline std::int64_t asked_moves(const CountedGoal& goal, std::int64_t moves) {
  return goal.on.empty() ? moves : std::ssize(goal.on);
}

/// Whether the goal is about this move.
inline bool asks(const CountedGoal& goal, const trial::MoveOutcome& move) {
  return goal.on.empty() || std::ranges::binary_search(goal.on, move.number);
}

/// The latest time in time, s: a sample at the very end is, although k·T may be rounded up.
inline double latest(const CountedGoal& goal) {
  constexpr double rounding = 1.0 + 1e-12;
  return goal.within * rounding;
}

/// When the move is within the goal's band, or tolerance, for good, or has arrived (of success), s; NaN if
/// never.
inline double settling_time(const CountedGoal& goal, const trial::MoveOutcome& move) {
  if (goal.tolerance) return move.tolerance_settling_times[*goal.tolerance];
  return goal.slot ? move.bands[*goal.slot].settling_time : move.settling_time;
}

/// Whether the move does what is asked. @param move that is asked
bool meets(const CountedGoal& goal, const trial::MoveOutcome& move);

/// Whether all moves that the goal asks meet it.
inline bool all_meet(const CountedGoal& goal, std::span<const trial::MoveOutcome> moves) {
  return std::ranges::all_of(
      moves, [&](const trial::MoveOutcome& move) { return !asks(goal, move) || meets(goal, move); });
}

/// Adds the moves of a trial that the goal asks. @returns how many meet it
std::int64_t count_moves(CellCounts& counts, const CountedGoal& goal, std::int64_t trial,
                         std::span<const trial::MoveOutcome> moves);

}  // namespace zerocount::measures
