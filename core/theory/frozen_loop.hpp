#pragma once

#include <complex>

#include "core/loop/parameters.hpp"
#include "core/loop/transfer_function.hpp"
#include "core/motion/parameters.hpp"
#include "core/theory/held_plant.hpp"

namespace zerocount::theory {

/// A sampled loop whose friction is frozen: a spring and a damper that do not change, in place of the
/// friction law. Its open loop, from error to count, is
///
///   L(z) = C(z)·G(z),
///
/// where C is the controller with all its blocks away from their limits, and G the plant in counts under the
/// delayed torque, held over a sample each.
struct FrozenLoop {
  HeldPlant plant;
  loop::LinearChain controller;
  double sample_time{0.0};  ///< T, s
};

/// The loop about a spring of `stiffness` (N m/rad) with the damping c (N m s/rad). While the rotor slides
/// the stiffness is 0 and the damping that of sliding.
/// @param controller a control without phases.
FrozenLoop frozen_loop(double stiffness, double damping, const motion::PlantParameters& plant,
                       const loop::EncoderParameters& encoder, const loop::ControllerParameters& controller,
                       const LinearDrive& drive = {});

/// L at z = exp(i·angle), angle = ωT.
std::complex<double> open_loop(const FrozenLoop& loop, double angle);

enum class LoopStability {
  stable,    ///< all eigenvalues of the closed loop lie inside the unit circle
  marginal,  ///< the largest lies on it (to edge_of_stability): something neither grows nor dies out
  unstable
};

LoopStability stability_of(const FrozenLoop& loop);

}  // namespace zerocount::theory
