#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <stop_token>

#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::trial {

enum class HookMode { stick, slide };

/// One sampling instant t_k of a trial: values at t_k, and the code and torque decided at t_k.
struct SampleRecord {
  std::int64_t k{0};             ///< Sample number from the start of the trial
  double t{0.0};                 ///< Time of the sample, s: k·T plus, with jitter, its lateness
  std::int64_t target{0};        ///< counts
  std::int64_t count{0};         ///< Fine encoder, counts
  std::int64_t coarse_count{0};  ///< Coarse encoder, counts
  std::int64_t error{0};         ///< Target − count, counts
  std::int64_t code{0};          ///< DAC code
  double torque{0.0};            ///< code·Δu, N m
  double theta{0.0};             ///< Rotor angle, rad
  double omega{0.0};             ///< Rotor velocity, rad/s
  double xp{0.0};                ///< Plastic extension, rad
  double xh{0.0};                ///< hardening, rad
  std::int64_t depth{0};         ///< Reversal points on the stack
  HookMode mode{HookMode::stick};
  /// Reference that the controller follows, counts; it equals the target once it has arrived there
  std::int64_t reference{0};
  loop::ControlPhase phase{loop::ControlPhase::fine};  ///< Phase of the control that decided the torque
  double load_theta{0.0};  ///< Angle of the second mass, rad; without one, of the rotor
  double load_omega{0.0};  ///< Velocity of the second mass, rad/s; without one, of the rotor
  /// Torque of the motor at this instant, after converter and amplifier, N m
  double drive_torque{0.0};
  /// Reading of the motor's encoder, in its own counts; load_count is the reading of the load's encoder. The
  /// one that closes the loop equals `count`.
  std::int64_t motor_count{0};
  std::int64_t load_count{0};
};

/// Callbacks while a trial runs; an empty function is not called.
struct TrialObservers {
  std::function<void(const SampleRecord&)> sample;  ///< Called at every sampling instant, in order.
  std::function<void(const Jerk&)> jerk;            ///< Called at the end of every jerk, in order of onset.
  std::stop_token stop{};                           ///< A request to stop ends the trial by Interrupted.
};

/// A trial was not run to its end, because a stop was requested.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

/// Runs one trial from t = 0 to the end of the last move:
///
///   for each move:  for each sample k = 0, 1, …
///     read the encoders at t_k; decide the code of the converter; add the sample to the measures
///     let the plant with its friction move under the motor's torque until t_{k+1}
///
/// With `verdict.stop` a trial ends at the sample at which a move has diverged (see divergence.hpp): up to
/// there samples and jerks do not depend on it.
///
/// A pure function: equal parameters give equal outcomes and records. Its memory does not grow with the
/// number of samples.
/// @throws Interrupted if a stop is requested before its last sample.
TrialOutcome run_trial(const TrialParameters& parameters, const TrialObservers& observers = {});

}  // namespace zerocount::trial
