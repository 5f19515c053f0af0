#pragma once

#include <Eigen/Core>

#include "core/motion/parameters.hpp"
#include "core/theory/sampled_stability.hpp"

namespace zerocount::theory {

/// The driven plant over one sample: x ← A·x + b·v with x = (count, change of the count per sample at the
/// present velocity; with a load both of the mass that the encoder does not read, its angle relative to the
/// measured one; with an amplifier its torque), v the decided torque (N m).
struct HeldPlant {
  Eigen::MatrixXd A;  ///< of counts and N m
  Eigen::VectorXd b;  ///< counts/(N m); 1 for the torque
};

/// Exact discretisation of J·θ¨ + damping·θ˙ + stiffness·θ = u − Ts, with the load of `plant`, and the
/// drive's input held over each sample.
/// @param stiffness N m/rad. @param damping N m s/rad. @param plant its inertia and load.
/// @param count_angle Δx, rad. @param sample_time T, s.
HeldPlant hold_plant(double stiffness, double damping, const motion::PlantParameters& plant,
                     double count_angle, double sample_time, const LinearDrive& drive);

}  // namespace zerocount::theory
