#pragma once

#include <numbers>

#include "core/plant/plant.hpp"

/// Scales of the paper's machine, and a plant under a constant torque, for the tests of this folder.
namespace zerocount::testing {

inline constexpr double count = 2.0 * std::numbers::pi / 1620000;  ///< count of the fine encoder, rad
inline constexpr double sample = 5e-4;                             ///< sample time, s
inline constexpr motion::MotionTolerance machine_tolerance{1e-10 * count};

/// A plant with pre-sliding friction, for tests that look at the state of the contact, with or without creep.
using PreslidingPlant = plant::PlantWith<friction::PreslidingFriction>;

/// Holds a constant torque (N m) for `duration` (s).
template <class AnyPlant>
void hold(AnyPlant& plant, double torque, double duration) {
  plant.advance(motion::constant_torque(torque), duration);
}

}  // namespace zerocount::testing
