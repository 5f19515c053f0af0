#pragma once

namespace zerocount::motion {

/// Tolerances of the motion.
struct MotionTolerance {
  /// Elongation (rad) that a Taylor step may leave out, and by which hardening must be exceeded before creep
  /// starts. A trial uses 1e-11 of a fine count.
  double elongation{4e-16};
  /// Elongation (rad) that may be left out where the rotor comes to rest: an oscillation of that amplitude
  /// counts as rest, and a loop of the spring that is open by no more counts as closed. A trial uses 1e-8 of
  /// a fine count.
  double rest{4e-14};
};

}  // namespace zerocount::motion
