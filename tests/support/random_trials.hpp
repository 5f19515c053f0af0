#pragma once

#include <cstdint>

#include "core/trial/parameters.hpp"

namespace zerocount::testing {

/// Kinds of random trials, by the behaviour of the loop.
enum class TrialKind {
  calm,              ///< a few counts at low gain: settles, creeps, jerks; the hook holds
  ringing,           ///< gains around and above the stability bounds
  breaking_away,     ///< thousands of counts or large gains: breakaway, slides, re-sticks
  unlike_the_paper,  ///< other machines: every parameter over orders of magnitude
  spring_alone,      ///< one of the first three with creep off by the friction model
  coulomb,           ///< Amonton–Coulomb friction, which hunts under integral control
  amplified,         ///< an amplifier of finite bandwidth, with each of the friction models
  arriving,          ///< a rotor that moves at the start, with the hook sticking or sliding
  remembering,       ///< a random history of the spring before the start
  loaded             ///< a second mass, the encoder at either; some with an amplifier or arriving
};

/// The parameters of random trial `index` of a kind: always the same for the same arguments. All parameters
/// of the model vary: creep exponents 1, 1.5, 2 and 3, creep off, preload of both signs, hardening, encoder
/// phase (0 included), delay, kp, kd, anti-windup, word length, negative targets, one to three moves, and
/// profiles of k1, k2 and breakaway.
trial::TrialParameters random_trial(TrialKind kind, std::uint64_t index);

}  // namespace zerocount::testing
