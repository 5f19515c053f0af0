#pragma once

#include <cstddef>

#include "core/numerics/power_series.hpp"

namespace zerocount::motion {

struct Load;
struct VaryingTorque;

/// The torque on the rotor from now on. It is the torque of the motor plus a constant disturbance, u(t) =
/// settled + (now − settled)·exp(−rate·t), minus the coupling torque of a load, if any, plus a varying
/// disturbance, if any. u is monotonic: constant if now equals settled, otherwise the response of a
/// first-order amplifier.
struct TorqueCourse {
  double now{0.0};      ///< The motor's torque u plus the constant disturbance at this instant, N m
  double settled{0.0};  ///< Final value that u approaches, N m
  double rate{0.0};     ///< Rate at which u approaches its final value, 1/s, not negative
  Load* load{nullptr};  ///< Load that moves with the rotor; null without one
  const VaryingTorque* disturbance{nullptr};
};

/// The course of a torque that stays at `torque` (N m).
inline TorqueCourse constant_torque(double torque) {
  return {torque, torque, 0.0};
}

/// Whether the motor's torque u(t) stays at its present value for ever.
inline bool motor_is_constant(const TorqueCourse& course) {
  return course.rate == 0.0 || course.now == course.settled;
}

/// The time (s) after which a varying motor torque u counts as settled: 37 time constants, because exp(−37)
/// is below the rounding of 1.
inline double time_to_settle(const TorqueCourse& course) {
  return 37.0 / course.rate;
}

/// Whether the applied torque, without the coupling torque of a load, stays at its present value for ever.
inline bool is_steady(const TorqueCourse& course) {
  return course.disturbance == nullptr && motor_is_constant(course);
}

/// Whether the whole torque on the rotor stays at its present value for ever.
inline bool is_constant(const TorqueCourse& course) {
  return course.load == nullptr && is_steady(course);
}

/// Whether a load or a varying disturbance acts on the rotor besides the motor's torque u.
inline bool is_coupled(const TorqueCourse& course) {
  return course.load != nullptr || course.disturbance != nullptr;
}

/// The torque on the rotor at this instant, including coupling and disturbance, N m.
/// @param omega velocity ω of the rotor, rad/s.
double torque_on_rotor(const TorqueCourse& course, double omega);

/// Direction in which the torque on the rotor changes: the sign of the result. Without a load, or with a
/// plain one (is_plain()), the result is the rate of change without the coupling, N m/s. With another load it
/// is the first non-zero derivative of the torque on a rotor that stands.
/// @param omega velocity ω of the rotor, rad/s.
double change_of_torque(const TorqueCourse& course, double omega);

/// Direction in which the rotor moves from now on: the sign of ω or, at ω = 0, of its first non-zero
/// derivative.
/// @param friction friction torque at ω = 0, N m.
double heading_under(const TorqueCourse& course, double omega, double friction);

/// Whether any oscillation between load and rotor has a coupling torque below `torque` (N m); true without a
/// load.
/// @param omega ω of the rotor, rad/s.
/// @param inertia J, kg m².
/// @param acceleration acceleration of the slow motion without the oscillation, rad/s². Up to a tenth of the
/// coupling torque that it needs may be missing.
bool load_is_quiet(const TorqueCourse& course, double omega, double inertia, double torque,
                   double acceleration = 0.0);

/// Sets the load, if any, to move with the rotor from now on, without an oscillation.
/// @param omega velocity ω of the rotor, rad/s.
void let_load_follow(const TorqueCourse& course, double omega);

/// The course of the torque as seen from the time t (s) on: t becomes the new time 0.
TorqueCourse course_after(const TorqueCourse& course, double t);

/// The time (s) at which the motor's torque u reaches `torque` (N m): 0 if it has passed it already, infinity
/// if it never does.
double time_until(const TorqueCourse& course, double torque);

/// Taylor coefficients of the motor's u(t), N m/sᵏ: c[0] = now, c[1] = −rate·(now − settled), c[k+1] =
/// −rate·c[k]/(k + 1).
inline numerics::Series torque_series(const TorqueCourse& course) {
  numerics::Series torque{};
  torque[0] = course.now;
  if (motor_is_constant(course)) return torque;
  torque[1] = -course.rate * (course.now - course.settled);
  for (std::size_t k = 1; k < numerics::series_order; ++k) {
    torque[k + 1] = -course.rate * torque[k] * numerics::reciprocal[k + 1];
  }
  return torque;
}

}  // namespace zerocount::motion
