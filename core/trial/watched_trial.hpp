#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/trial/outcome.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::trial {

/// Quantities of a closed loop at one sample that its record does not contain.
struct LoopSample {
  const SampleRecord& record;
  /// Torque of the controller when it last ran, before dither, limit and rounding, N m.
  double wanted;
  std::int64_t steps;  ///< Number of integration steps of the plant since the start of the trial
};

/// Function that is called at every sample of a closed loop. It returns false to end the trial.
using LoopWatch = std::function<bool(const LoopSample&)>;

/// Runs a closed loop as run_trial() does, and calls `watch` at each sample.
/// @returns the outcome; empty if `watch` ended the trial.
std::optional<TrialOutcome> watch_trial(const TrialParameters& parameters, const LoopWatch& watch);

}  // namespace zerocount::trial
