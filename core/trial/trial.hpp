#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <stop_token>

#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::trial {

enum class HookMode { stick, slide };

/// State of a trial at one sampling instant t_k, and the code and torque that are decided at t_k.
struct SampleRecord {
  std::int64_t k{0};             ///< Number of the sample, counted from the start of the trial
  double t{0.0};                 ///< Time of the sample, s: k·T plus, with jitter, its lateness
  std::int64_t target{0};        ///< Target of the present move, counts
  std::int64_t count{0};         ///< Count of the fine encoder
  std::int64_t coarse_count{0};  ///< Count of the coarse encoder
  std::int64_t error{0};         ///< Control error, target − count, counts
  std::int64_t code{0};          ///< Code sent to the digital-to-analogue converter
  double torque{0.0};            ///< Torque of the code, code·Δu, N m
  double theta{0.0};             ///< Rotor angle, rad
  double omega{0.0};             ///< Rotor velocity, rad/s
  double xp{0.0};                ///< Plastic extension xp of the contact by creep, rad
  double xh{0.0};                ///< Hardening xh of the contact by creep, rad
  std::int64_t depth{0};         ///< Number of reversal points on the spring's stack
  HookMode mode{HookMode::stick};
  /// Reference that the controller follows, counts; it equals the target once it has arrived there
  std::int64_t reference{0};
  loop::ControlPhase phase{loop::ControlPhase::fine};  ///< Phase of a two-phase control that decided the
                                                       ///< torque; otherwise fine
  double load_theta{0.0};  ///< Angle of the second mass, rad; without one, of the rotor
  double load_omega{0.0};  ///< Velocity of the second mass, rad/s; without one, of the rotor
  /// Torque of the motor at this instant, after converter, delay and amplifier, N m
  double drive_torque{0.0};
  /// Count of the motor's encoder, in its own counts; load_count is the count of the load's encoder. The one
  /// that closes the loop equals `count`.
  std::int64_t motor_count{0};
  std::int64_t load_count{0};
};

/// Callback functions that a running trial calls; an empty function is not called.
struct TrialObservers {
  std::function<void(const SampleRecord&)> sample;  ///< Called at every sampling instant, in order.
  std::function<void(const Jerk&)> jerk;            ///< Called at the end of every jerk (excursion of the
                                                    ///< error from zero after arrival), in order of onset.
  std::stop_token stop{};                           ///< Stops the trial when a stop is requested: run_trial()
                                                    ///< then throws Interrupted.
};

/// Exception that ends a trial before its last sample, because a stop was requested.
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
