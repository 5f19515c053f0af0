#pragma once

#include <cstdint>

#include "core/friction/parameters.hpp"
#include "core/loop/parameters.hpp"
#include "core/motion/parameters.hpp"

/// Approach to zero error under slow integral control: the torque follows the spring without oscillation.
namespace zerocount::theory {

/// Time constant of the error about a spring of `stiffness` k (N m/rad), s:
///
///   τ = T·(k·Δx + kp)/(2·ki).
///
/// The limit of slowest_time_constant of the sampled loop for a loop much slower than the plant.
double slow_time_constant(double stiffness, const loop::EncoderParameters& encoder,
                          const loop::ControllerParameters& controller);

/// Time from a step of `step` counts (at least 1) to the count of its target, s, where the rotor reverses as
/// it begins: the stiffness falls with the travel on the branch, so that, e being the error in counts,
///
///   t = ∫ τ(k1 + k2·exp(−β·Δx·(step − e)))/e de  from ½ to step.
///
/// Needs ki > 0.
double slow_arrival_time(std::int64_t step, const friction::FrictionParameters& contact,
                         const loop::EncoderParameters& encoder,
                         const loop::ControllerParameters& controller);

/// Time for which the count chatters on the edge of the target before it has held it for `dwell` (s), s. With
/// each count that the error falls, kp takes kp off the torque, and the rotor falls back over the edge: the
/// error is then 1 for a proportion of the time that decays with T·kp/(2·ki), as the integral takes over. One
/// excursion lasts about a period of the contact's natural frequency f, so that there is none within a dwell
/// once the proportion is 1/(f·dwell):
///
///   t = T·kp/(2·ki)·ln(f·dwell), at least 0.
///
/// Needs ki > 0.
double chatter_time(const motion::PlantParameters& plant, const friction::FrictionParameters& contact,
                    const loop::ControllerParameters& controller, double dwell);

}  // namespace zerocount::theory
