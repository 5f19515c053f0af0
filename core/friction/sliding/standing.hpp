#pragma once

#include "core/motion/torque_course.hpp"

namespace zerocount::friction {

/// A step of a rotor at rest.
struct StandStep {
  double time;       ///< that it took, s
  double direction;  ///< in which the torque releases the rotor at its end: −1, 1; 0: it still stands
};

/// Lets a rotor stand under a torque with a load or a varying disturbance, as far as a Taylor step goes, or
/// until the torque on it, u − Ts, exceeds the breakaway torque. Moves the load.
/// @param breakaway Fs, N m. @param inertia J, kg m². @param tolerance of the load's twist, rad.
/// @param duration longest step, s.
StandStep stand_step(double breakaway, double inertia, const motion::TorqueCourse& torque, double tolerance,
                     double duration);

}  // namespace zerocount::friction
