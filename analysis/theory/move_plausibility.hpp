#pragma once

#include "analysis/theory/goal_of_trial.hpp"

/// Moves that the drive, the reference or the encoder keeps from their goal.
namespace zerocount::theory {

/// A tolerance or band of half of a step or more: the move is within it on its way.
Doubt band_is_half_a_step(const GoalOfTrial& of);

/// At `within` the reference of the move is still farther from its end than the band or tolerance.
Doubt reference_is_on_its_way(const MoveOfTrial& move);

/// The move takes longer than it may, even at the largest torque (shortest_move): with the inertia that it
/// has to move (of a second mass unless the motor can move without it), the
/// constant disturbance, and with ripple and vibration always in its favour. Before it slides, a law with
/// presliding motion is taken to have no friction; over what travel is five times breakaway over its softest
/// stiffness. Not said of an axis with a random vibration, which has no largest torque.
Doubt torque_is_too_small_for_the_move(const MoveOfTrial& move);

/// Constant disturbance and ripple at the target exceed the largest torque.
Doubt torque_is_too_small_at_the_target(const MoveOfTrial& move);

/// The systematic errors of the encoder (eccentricity, interpolation): nowhere within the tolerance does it
/// read the target.
Doubt encoder_misplaces_the_target(const MoveOfTrial& move);

}  // namespace zerocount::theory
