#pragma once

#include <cstdint>

#include "core/trial/parameters.hpp"

namespace zerocount::testing {

/// Kinds of random trials that use all features of the control loop (encoders, converter, references and so
/// on).
enum class WidenedKind {
  two_phases,  ///< moves of tens to thousands of counts, with a coarse and a fine phase
  one_phase,   ///< moves of tens of counts with a single phase, which arrive, creep and jerk
  open_loop    ///< open loop: the command is a list of torque levels
};

/// The parameters of random trial `index` of a kind: always the same for the same arguments. Two to four
/// moves with step, trapezoidal and s-curve references; the encoders that feed back, with and without errors;
/// delay, converter with and without errors, amplifier; anti-windup; starts of every kind.
trial::TrialParameters widened_trial(WidenedKind kind, std::uint64_t index);

}  // namespace zerocount::testing
