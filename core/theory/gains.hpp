#pragma once

#include "core/loop/controller/pid.hpp"
#include "core/loop/encoder.hpp"
#include "core/loop/parameters.hpp"

namespace zerocount::theory {

/// PID gains of the continuous loop u = kP·e + kI·∫e dt + kD·de/dt with the error in rad, as in the paper's
/// equation (4).
struct AnalogueGains {
  double kp{0.0};  ///< Proportional gain kP, N m/rad
  double ki{0.0};  ///< Integral gain kI, N m/(rad s)
  double kd{0.0};  ///< Derivative gain kD, N m s/rad
};

/// Sample time T of the controller, 1/sample rate, s.
double sample_time(const loop::ControllerParameters& controller);

/// The gains of the continuous PID law that a sampled controller stands for. The resolution Δx belongs to the
/// fine encoder, whichever encoder closes the loop, because the count of the coarse one is converted to fine
/// counts.
///
/// kP = kp/Δx, kI = 2·ki/(Δx·T), kD = kd·T/Δx: the proportional term counts the error, the trapezoidal rule
/// adds kI·Δx·T/2 for each of two successive errors, and the difference of successive counts is the velocity
/// times T/Δx.
AnalogueGains analogue_gains(const loop::ControllerParameters& controller,
                             const loop::EncoderParameters& encoder);

/// The gains of the sampled PID law that stand for the continuous gains `gains` at the sample rate of
/// `controller`: kp = kP·Δx, ki = kI·Δx·T/2, kd = kD·Δx/T. Inverse of analogue_gains().
loop::PidGains sampled_gains(const AnalogueGains& gains, const loop::ControllerParameters& controller,
                             const loop::EncoderParameters& encoder);

}  // namespace zerocount::theory
