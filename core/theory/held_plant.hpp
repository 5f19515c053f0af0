#pragma once

#include <Eigen/Core>

#include "core/motion/parameters.hpp"
#include "core/theory/sampled_stability.hpp"

namespace zerocount::theory {

/// The driven plant over sample k: x ← A·x + b·v[k − delay] + b_before·v[k − delay − 1] with x = (count,
/// change of the count per sample at the present velocity; with a load both of the mass that the encoder does
/// not read, its angle relative to the measured one; with an amplifier its torque), v the decided torques (N
/// m).
struct HeldPlant {
  Eigen::MatrixXd A;         ///< of counts and N m
  Eigen::VectorXd b;         ///< counts/(N m); 1 for the torque
  Eigen::VectorXd b_before;  ///< 0 for a delay of whole samples
  int delay{0};              ///< whole samples between deciding a torque and applying it
  /// Counts of the encoder of the other mass in one of the fine one, where the velocity loop reads it; else
  /// 0.
  double other_per_count{0.0};
};

/// Exact discretisation of J·θ¨ + damping·θ˙ + stiffness·θ = u − Ts, with the load of `plant`, and the
/// drive's input held over each sample. The coupling is in contact and without an error, the load without
/// its friction.
/// @param stiffness N m/rad. @param damping N m s/rad. @param plant its inertia and load.
/// @param count_angle Δx, rad. @param sample_time T, s.
/// @param delay samples between deciding a torque and applying it, whole or not.
HeldPlant hold_plant(double stiffness, double damping, const motion::PlantParameters& plant,
                     double count_angle, double sample_time, const LinearDrive& drive, double delay = 0.0);

}  // namespace zerocount::theory
