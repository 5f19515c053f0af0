#pragma once

namespace zerocount::motion {

/// Tolerances of the motion integrator.
struct MotionTolerance {
  /// Truncation error allowed per Taylor step, and the excess of hardening that starts creep, rad. A trial
  /// uses 1e-11 of a fine count.
  double elongation{4e-16};
  /// Amplitude below which an oscillation counts as rest, and the opening below which a loop of the spring
  /// counts as closed, rad. A trial uses 1e-8 of a fine count.
  double rest{4e-14};
};

}  // namespace zerocount::motion
