#pragma once

#include "core/trial/parameters.hpp"

namespace zerocount::testing {

/// Whether the reversal depths that run_trial() finds depend on the steps of the plant. The steps are varied
/// in two ways: samples are divided, or samples with the same torque are joined; and the truncation error
/// allowed per step is changed. The depths depend on the steps if a hysteresis loop closes, or fails to
/// close, by less than the accuracy of the motion, as in a limit cycle that retraces itself. They also do if
/// a loop closes while the last oscillation falls below the amplitude of rest.
bool reversal_depth_changes_with_steps(const trial::TrialParameters& parameters);

}  // namespace zerocount::testing
