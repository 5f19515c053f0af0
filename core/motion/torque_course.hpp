#pragma once

#include <cstddef>

#include "core/numerics/power_series.hpp"

namespace zerocount::motion {

/// The motor's torque from now on: u(t) = settled + (now − settled)·exp(−rate·t). Constant where now equals
/// settled; otherwise that of a first-order amplifier. It is monotonic.
struct TorqueCourse {
  double now{0.0};      ///< N m
  double settled{0.0};  ///< N m
  double rate{0.0};     ///< 1/s, not negative
};

/// The course that stays at `torque` (N m).
inline TorqueCourse constant_torque(double torque) {
  return {torque, torque, 0.0};
}

/// Whether u(t) = now for ever.
inline bool is_constant(const TorqueCourse& course) {
  return course.rate == 0.0 || course.now == course.settled;
}

/// The same course seen from the time t (s) on.
TorqueCourse course_after(const TorqueCourse& course, double t);

/// The time (s) at which u reaches `torque` (N m): 0 where it has passed it, infinity where it never does.
double time_until(const TorqueCourse& course, double torque);

/// Taylor coefficients of u(t), N m/sᵏ: c[0] = now, c[1] = −rate·(now − settled), c[k+1] = −rate·c[k]/(k +
/// 1).
inline numerics::Series torque_series(const TorqueCourse& course) {
  numerics::Series torque{};
  torque[0] = course.now;
  if (is_constant(course)) return torque;
  torque[1] = -course.rate * (course.now - course.settled);
  for (std::size_t k = 1; k < numerics::series_order; ++k) {
    torque[k + 1] = -course.rate * torque[k] * numerics::reciprocal[k + 1];
  }
  return torque;
}

}  // namespace zerocount::motion
