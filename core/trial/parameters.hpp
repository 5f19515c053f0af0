#pragma once

#include <cstdint>
#include <vector>

#include "core/friction/parameters.hpp"
#include "core/loop/parameters.hpp"
#include "core/plant/parameters.hpp"

namespace zerocount {

/// The moves of a trial: each target is held for the same time.
struct CommandParameters {
  std::vector<std::int64_t> targets;  ///< counts from the start of the trial, one per move
  double hold{1.0};                   ///< s per move
};

/// What the trial finds at t = 0.
struct InitialConditions {
  double encoder_phase{0.5};  ///< where in a count the rotor stands, in [0, 1)
  double position{0.0};       ///< where on the rotor the contact is, rad; selects from the profiles
  double hardening{0.0};      ///< xh, rad
  double preload{0.0};  ///< torque of a slow load-and-unload from virgin before t = 0, without creep, N m
};

/// How a move is judged.
struct VerdictParameters {
  double dwell{0.05};   ///< time at zero error that makes an arrival, s
  double window{0.05};  ///< last part of the move, by which its outcome is judged, s
};

/// Everything that determines a trial: two equal sets give the same trial, bit for bit.
struct TrialParameters {
  PlantParameters plant;
  FrictionAlongRotor friction;
  EncoderParameters encoder;
  DacParameters dac;
  ControllerParameters controller;
  CommandParameters command;
  InitialConditions initial;
  VerdictParameters verdict;
};

/// Number of whole samples in `duration` (s) at `sample_rate` (Hz): round(duration·sample_rate).
std::int64_t samples_in(double duration, double sample_rate);

/// Number of samples of one move.
std::int64_t samples_per_move(const TrialParameters& parameters);

}  // namespace zerocount
