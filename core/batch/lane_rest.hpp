#pragma once

#include <functional>

#include "core/batch/lane_trial.hpp"

namespace zerocount::batch {

/// A sampling instant at which nothing changed, `passed` samples after the last processed one.
using PassedSample = std::function<void(double passed, double theta, const friction::CreepState& creep)>;

/// Applies the rest rule. A lane at rest advances in closed form, by creep and residual oscillation, to the
/// next stop or to the first sampling instant at which its count differs.
/// @param passed called for every sample before that one; may be empty.
/// @returns whether the lane was at rest; then it is at a stop.
bool rest(BatchState& batch, int lane, LaneTrial& trial, const PassedSample& passed);

/// Advances the plant of a lane at rest to where the lane is.
void bring_up_to_date(BatchState& batch, int lane, LaneTrial& trial);

/// Accounts for `samples` samples with zero error and an unchanged torque.
void pass_samples(BatchState& batch, int lane, double samples);

}  // namespace zerocount::batch
