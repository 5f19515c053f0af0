#pragma once

#include <cstdint>
#include <limits>

namespace zerocount {

/// Moves that are off target: stalled, or still on their way when their hold ended. They are undecided,
/// neither stable nor shown unstable.
struct UndecidedMoves {
  std::int64_t moves{0};          ///< of all trials
  std::int64_t off_target{0};     ///< of them, undecided
  std::int64_t still_falling{0};  ///< of these, with an error that fell in the last half of the hold
  /// Moves that count as oscillating whose error fell likewise and kept its sign, with a ripple of a count:
  /// a proportional gain makes the count chatter on the edges that it passes.
  std::int64_t falling_with_ripple{0};
  /// Hold that most of those whose error still fell are expected to need, s; NaN where there are none, or
  /// nothing in their control brings the error to zero.
  double advised_hold{std::numeric_limits<double>::quiet_NaN()};
};

}  // namespace zerocount
