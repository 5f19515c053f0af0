#pragma once

#include "core/motion/parameters.hpp"

namespace zerocount::theory {

/// The plant with its inertia in two halves, motor and load, that swing against each other; the encoder is on
/// the motor, and the coupling's damping is 1 % of the critical one. The sum of the inertias is kept.
/// @param plant without a second mass
/// @param frequency of the free mode, Hz
motion::PlantParameters with_load_mode(motion::PlantParameters plant, double frequency);

}  // namespace zerocount::theory
