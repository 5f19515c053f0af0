#pragma once

#include "core/motion/parameters.hpp"
#include "core/motion/torque_course.hpp"

namespace zerocount::friction {

/// State of a rotor without friction.
struct FreeMotion {
  double theta{0.0};  ///< rad
  double omega{0.0};  ///< rad/s
};

/// The rotor of FrictionModel::none, an air bearing, after the time t (s) from `start` under `torque`:
///
///   J·dω/dt = u(t) − c·ω,   dθ/dt = ω,   u(t) = U + (u(0) − U)·e^(−rt),
///
/// c = PlantParameters::presliding_damping. In closed form, with a = c/J and divided differences of exp,
///
///   ω(t) = ω(0)·e^(−at) + U/J·t·exp[0, −at] + (u(0) − U)/J·t·exp[−at, −rt]
///   θ(t) = θ(0) + ω(0)·t·exp[0, −at] + U/J·t²·exp[0, 0, −at] + (u(0) − U)/J·t²·exp[0, −at, −rt].
///
/// With c = 0 the rotor is free.
FreeMotion free_motion(const motion::PlantParameters& plant, const FreeMotion& start,
                       const motion::TorqueCourse& torque, double t);

}  // namespace zerocount::friction
