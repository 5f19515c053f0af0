#pragma once

#include <optional>

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
  double sample_time{0.0};  ///< Sample time T, s
  /// Whether the loop controls a position. A velocity loop alone leaves the position free; G then leads to
  /// the count that the velocity loop reads.
  bool closes_position{true};
};

/// The loop in which the masses move together, each against its spring and damper. While the rotor slides,
/// its spring has stiffness 0 and its damper the sliding damping.
/// @param controller a control without phases.
FrozenLoop frozen_loop(const FrozenFriction& friction, const motion::PlantParameters& plant,
                       const loop::EncoderParameters& encoder, const loop::ControllerParameters& controller,
                       const LinearDrive& drive = {});

/// The loop in which the motor moves and the load does not, because the gap is open or the load stands. An
/// encoder on the load then reads a constant, so that only the paths from the motor's encoder close the loop.
/// Empty if the controller does not read the motor, because the loop is then cut.
/// @param friction spring and damper of the motor's friction, and of the coupling if it is in contact.
std::optional<FrozenLoop> loop_of_motor_alone(const FrozenFriction& friction,
                                              const motion::PlantParameters& plant,
                                              const loop::EncoderParameters& encoder,
                                              const loop::ControllerParameters& controller,
                                              const LinearDrive& drive = {});

/// Open-loop frequency response L(z) of the sampled loop, from error to count.
OpenLoop open_loop(const FrozenLoop& loop);

/// The poles z of the closed loop: the eigenvalues of loop_map(), without the eigenvalue of a free position.
Eigen::VectorXcd poles_of(const FrozenLoop& loop);

/// Stability of a linear loop within a move, by the motion that grows fastest or dies out last.
enum class LoopStability {
  stable,    ///< The motion dies out, by more than a thousandth within the hold, however slowly.
  marginal,  ///< The motion changes by less than a thousandth within the hold: for practical use, an
             ///< eigenvalue of 1.
  unstable   ///< The motion grows by more than a thousandth within the hold.
};

/// The stability of a loop with these poles over a move of `hold` (s). The pole z of largest magnitude has
/// the time constant τ = −T/ln|z|, and changes its motion by the factor exp(−hold/τ).
LoopStability stability_of(const Eigen::VectorXcd& poles, double sample_time, double hold);
LoopStability stability_of(const FrozenLoop& loop, double hold);

/// The logarithm of the factor by which the motion that grows fastest, or dies out last, changes within
/// `hold` (s). Negative if it dies out, positive if it grows.
double log_growth(const FrozenLoop& loop, double hold);

/// Time constant (s) of the motion that dies out last, oscillating or not: −T/ln|z| for the pole z of largest
/// magnitude. 0 where all motion is gone after a sample, infinite where a pole does not decay.
double slowest_time_constant(const Eigen::VectorXcd& poles, double sample_time);

}  // namespace zerocount::theory
