#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <stop_token>

#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::trial {

enum class HookMode { stick, slide };

/// One sampling instant t_k of a trial. Values are those at t_k; code and torque those decided at t_k.
struct SampleRecord {
  std::int64_t k{0};             ///< sample number from the start of the trial
  double t{0.0};                 ///< k·T and, with jitter, how late the sample is, s
  std::int64_t target{0};        ///< counts
  std::int64_t count{0};         ///< fine encoder, counts
  std::int64_t coarse_count{0};  ///< coarse encoder, counts
  std::int64_t error{0};         ///< target − count, counts
  std::int64_t code{0};          ///< DAC code
  double torque{0.0};            ///< code·Δu, N m
  double theta{0.0};             ///< rotor angle, rad
  double omega{0.0};             ///< rotor velocity, rad/s
  double xp{0.0};                ///< plastic extension, rad
  double xh{0.0};                ///< hardening, rad
  std::int64_t depth{0};         ///< reversal points on the stack
  HookMode mode{HookMode::stick};
  std::int64_t reference{0};  ///< that the controller follows, counts: the target once arrived there
  loop::ControlPhase phase{loop::ControlPhase::fine};  ///< that decided the torque
  double load_theta{0.0};    ///< angle of the second mass, rad; of the rotor without one
  double load_omega{0.0};    ///< velocity of the second mass, rad/s; of the rotor without one
  double drive_torque{0.0};  ///< of the motor at this instant, after converter and amplifier, N m
  /// Readings of the motor's and the load's encoder, where each has one, in counts of each; one is `count`.
  std::int64_t motor_count{0};
  std::int64_t load_count{0};
};

/// Callbacks while a trial runs; an empty function is not called.
struct TrialObservers {
  std::function<void(const SampleRecord&)> sample;  ///< at every sampling instant, in order
  std::function<void(const Jerk&)> jerk;            ///< at the end of every jerk, in order of onset
  std::stop_token stop{};                           ///< a request to stop ends the trial by Interrupted
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
