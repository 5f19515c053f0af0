#pragma once

#include <vector>

#include "core/trial/trial.hpp"
#include "tests/support/odeint_motion.hpp"

namespace zerocount::testing {

/// The samples of a trial, computed in a deliberately different way to check run_trial(): Boost.odeint with
/// located events for the plant, and a separately written controller.
/// @param events receives the counts of the contact's events; may be null
std::vector<trial::SampleRecord> odeint_trial(const trial::TrialParameters& parameters,
                                              EventCounts* events = nullptr);

}  // namespace zerocount::testing
