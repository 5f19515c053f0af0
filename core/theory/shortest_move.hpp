#pragma once

namespace zerocount::theory {

/// An axis that bounded torques move.
struct DrivenAxis {
  double inertia;  ///< J, N m s²/rad
  double damping;  ///< c, viscous, N m s/rad
  double driving;  ///< largest torque in the direction of the move, friction subtracted, N m
  double braking;  ///< largest torque against it, friction added, N m
};

/// The shortest time (s) in which the axis moves by `distance` (rad) from rest to rest: all of the driving
/// torque up to some velocity, then all of the braking torque,
///
///     J·dω/dt = driving − c·ω,   then   J·dω/dt = −braking − c·ω.
///
/// Infinite where one of the torques is not above 0. Source: Bryson and Ho, "Applied Optimal Control", 1975,
/// section 3.9 (the double integrator).
double shortest_move(const DrivenAxis& axis, double distance);

}  // namespace zerocount::theory
