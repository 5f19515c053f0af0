#pragma once

#include "core/loop/controller/pid.hpp"
#include "core/loop/encoder.hpp"
#include "core/loop/parameters.hpp"

namespace zerocount::theory {

/// PID gains of the continuous loop u = kP·e + kI·∫e dt + kD·de/dt with the error in rad, as in the paper's
/// equation (4).
struct AnalogueGains {
  double kp{0.0};  ///< N m/rad
  double ki{0.0};  ///< N m/(rad s)
  double kd{0.0};  ///< N m s/rad
};

/// Sample time T = 1/sample rate, s.
double sample_time(const loop::ControllerParameters& controller);

/// The continuous gains that a sampled controller stands for. Δx belongs to the fine encoder, whichever
/// encoder closes the loop, because the count of the coarse one is converted to fine counts.
///
/// kP = kp/Δx, kI = 2·ki/(Δx·T), kD = kd·T/Δx: the proportional term counts the error, the trapezoidal rule
/// adds kI·Δx·T/2 for each of two successive errors, and the difference of successive counts is the velocity
/// times T/Δx.
AnalogueGains analogue_gains(const loop::ControllerParameters& controller,
                             const loop::EncoderParameters& encoder);

/// The gains of the sampled law that stand for `gains` at the sample rate of `controller`: kp = kP·Δx,
/// ki = kI·Δx·T/2, kd = kD·Δx/T. Inverse of analogue_gains().
loop::PidGains sampled_gains(const AnalogueGains& gains, const loop::ControllerParameters& controller,
                             const loop::EncoderParameters& encoder);

}  // namespace zerocount::theory
