#pragma once

#include <cstdint>

#include "core/friction/parameters.hpp"
#include "core/loop/parameters.hpp"
#include "core/motion/parameters.hpp"

namespace zerocount::theory {

// Approach to zero error under slow integral control: the torque follows the spring without oscillation.

/// Time constant (s) with which the control error decays slowly, if the contact acts as a spring of
/// `stiffness` k (N m/rad):
///
///   τ = T·(k·Δx + kp)/(2·ki).
///
/// It is the limit of slowest_time_constant() of the sampled loop for a loop much slower than the plant.
double slow_time_constant(double stiffness, const loop::EncoderParameters& encoder,
                          const loop::ControllerParameters& controller);

/// Time (s) from a step of `step` counts (at least 1) to its target, if the rotor reverses at its start: the
/// stiffness falls with the travel on the branch, so that, e being the error in counts,
///
///   t = ∫ τ(k1 + k2·exp(−β·Δx·(step − e)))/e de  from ½ to step.
///
/// Needs ki > 0.
double slow_arrival_time(std::int64_t step, const friction::FrictionParameters& contact,
                         const loop::EncoderParameters& encoder,
                         const loop::ControllerParameters& controller);

/// Time (s) for which the count chatters on the edge of the target before it stays there for `dwell` (s).
/// When the error falls by a count, the torque falls by kp, and the rotor moves back over the edge: the error
/// is 1 for a proportion of the time that decays with T·kp/(2·ki), as the integral takes over. One excursion
/// takes about a period of the contact's natural frequency f, so that a dwell is free of them once the
/// proportion is 1/(f·dwell):
///
///   t = T·kp/(2·ki)·ln(f·dwell), at least 0.
///
/// Needs ki > 0.
double chatter_time(const motion::PlantParameters& plant, const friction::FrictionParameters& contact,
                    const loop::ControllerParameters& controller, double dwell);

/// An axis that is moved by bounded torques, for the shortest possible move.
struct DrivenAxis {
  double inertia;  ///< Inertia J, N m s²/rad
  double damping;  ///< Viscous damping c, N m s/rad
  double driving;  ///< Largest motor torque in the direction of the move, minus friction, N m
  double braking;  ///< Largest motor torque against the move, plus friction, N m
};

/// The shortest time (s) in which the axis moves by `distance` (rad) from rest to rest: all of the driving
/// torque up to some velocity, then all of the braking torque,
///
///     J·dω/dt = driving − c·ω,   then   J·dω/dt = −braking − c·ω.
///
/// Infinite if one of the torques is not above 0. Source: Bryson and Ho, "Applied Optimal Control", 1975,
/// section 3.9 (the double integrator).
double shortest_move(const DrivenAxis& axis, double distance);

}  // namespace zerocount::theory
