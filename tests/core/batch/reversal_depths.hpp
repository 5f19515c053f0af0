#pragma once

#include "core/trial/parameters.hpp"

namespace zerocount::testing {

/// Whether the reversal depths that run_trial finds change with the steps by which the plant goes through its
/// torques: with samples in pieces, or those of the same torque together, and with more or less left out in
/// each. So it is with loops that close, or do not, by less than the motion is followed to, as in a limit
/// cycle that comes to retrace itself; and with a loop that closes while the last oscillation falls below the
/// amplitude of rest.
bool reversal_depth_changes_with_steps(const trial::TrialParameters& parameters);

}  // namespace zerocount::testing
