#pragma once

#include <vector>

#include "core/trial/trial.hpp"
#include "tests/support/odeint_motion.hpp"

namespace zerocount::testing {

/// The samples of a trial by a second, deliberately different way: Boost.odeint with located events for the
/// plant, and a controller written apart. The judge of run_trial; `events`, where given, receives what
/// happened at the contact.
std::vector<trial::SampleRecord> odeint_trial(const trial::TrialParameters& parameters,
                                              EventCounts* events = nullptr);

}  // namespace zerocount::testing
