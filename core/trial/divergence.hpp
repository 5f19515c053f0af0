#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

/// Early end of a move that has diverged, and of its trial.
namespace zerocount::trial {

/// Whether a move has diverged at a sample with the error e = `error`, counts. Always false without
/// `verdict.stop`. Otherwise it has diverged if
///
///   |e| > limit + |e_0|,
///
/// where e_0 = `first_error` is the error at the move's first sample. |e_0| is the size of the step, whatever
/// the reference does, and a move that settles may overshoot by nearly as much.
inline bool diverged(const VerdictParameters& verdict, std::int64_t first_error, std::int64_t error) {
  return verdict.stop &&
         static_cast<double>(std::abs(error)) > verdict.limit + static_cast<double>(std::abs(first_error));
}

/// The outcome of a move that follows a diverged move. It was not run, because its initial state is unknown.
/// It counts as oscillating and stopped; its real measures are NaN, its whole ones 0.
/// @param number number of the move in its trial.
inline MoveOutcome move_not_run(std::size_t number = 0) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  MoveOutcome move;
  move.number = static_cast<std::int64_t>(number);
  move.outcome = Outcome::oscillating;
  move.stopped = true;
  move.travel_time = none;
  move.final_position = none;
  move.holding_torque = none;
  move.peak_torque = none;
  move.creep = none;
  return move;
}

/// Whether any sample of the move was run.
inline bool was_run(const MoveOutcome& move) {
  return !move.stopped || !std::isnan(move.final_position);
}

}  // namespace zerocount::trial
