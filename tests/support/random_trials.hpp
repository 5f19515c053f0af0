#pragma once

#include <cstdint>

#include "core/trial/parameters.hpp"

namespace zerocount::testing {

/// Kinds of random trials, by the behaviour of the loop.
enum class TrialKind {
  /// Moves of a few counts at low gain: the axis settles, creeps and jerks, and the contact does not slide.
  calm,
  ringing,  ///< gains around and above the stability bounds
  /// Moves of thousands of counts or large gains: the contact breaks away, slides and sticks again.
  breaking_away,
  unlike_the_paper,  ///< other machines: every parameter over orders of magnitude
  spring_alone,      ///< one of the first three kinds, with creep switched off by the friction model
  coulomb,           ///< Amonton–Coulomb friction, which hunts under integral control
  amplified,         ///< an amplifier of finite bandwidth, with each of the friction models
  arriving,          ///< the rotor moves at the start, with the contact sticking or sliding
  remembering,       ///< the spring has a random history of loading before the start
  loaded  ///< a second mass, with the encoder on either mass; some with an amplifier or a moving start
};

/// The parameters of random trial `index` of a kind: always the same for the same arguments. All parameters
/// of the model vary: creep exponents 1, 1.5, 2 and 3, creep off, preload of both signs, hardening, encoder
/// phase (0 included), delay, kp, kd, anti-windup, word length, negative targets, one to three moves, and
/// profiles of k1, k2 and breakaway.
trial::TrialParameters random_trial(TrialKind kind, std::uint64_t index);

}  // namespace zerocount::testing
