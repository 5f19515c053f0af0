#pragma once

#include <vector>

#include "core/trial/parameters.hpp"

namespace zerocount::trial {

/// The levels (N m) of a random history, in order. With u_k = open_uniform of number k of the history's key:
/// the first level lies upwards where u_0 ≥ ½ and downwards otherwise, and the direction changes from level
/// to level; level k = 1 … reversals is
///
///   l_k = l_{k−1} + u_k·(±torque − l_{k−1}),   l_0 = 0,
///
/// evenly distributed between the level before and the largest torque in its direction.
std::vector<double> draw_history(const RandomHistory& history, const random::TrialRandomness& randomness);

}  // namespace zerocount::trial
