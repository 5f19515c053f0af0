#pragma once

#include "core/loop/controller/control_block.hpp"
#include "core/loop/parameters.hpp"
#include "core/motion/parameters.hpp"
#include "core/theory/linear_loop.hpp"

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

/// L of the loop.
OpenLoop open_loop(const FrozenLoop& loop);

/// The poles z of the closed loop: the eigenvalues of loop_map.
Eigen::VectorXcd poles_of(const FrozenLoop& loop);

/// Behaviour, within a move, of the motion that grows fastest or dies out last.
enum class LoopStability {
  stable,    ///< it dies out, by more than a thousandth within the hold, however slowly
  marginal,  ///< it changes by less than a thousandth within the hold: an eigenvalue of 1, for practical use
  unstable   ///< it grows, by more than a thousandth within the hold
};

/// The stability of a loop with these poles over a move of `hold` (s). The pole z of largest magnitude has
/// the time constant τ = −T/ln|z|, and changes its motion by the factor exp(−hold/τ).
LoopStability stability_of(const Eigen::VectorXcd& poles, double sample_time, double hold);
LoopStability stability_of(const FrozenLoop& loop, double hold);

/// The logarithm of the factor by which the motion that grows fastest, or dies out last, changes within
/// `hold` (s); below 0 where it dies out.
double log_growth(const FrozenLoop& loop, double hold);

/// The slowest time constant of an approach without oscillation, s: −T/ln z of the largest real pole z in
/// (1e-6, 1); 0 without one, infinite where a pole does not decay.
double slowest_time_constant(const Eigen::VectorXcd& poles, double sample_time);

}  // namespace zerocount::theory
