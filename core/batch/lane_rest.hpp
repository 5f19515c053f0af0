#pragma once

#include <functional>

#include "core/batch/lane_trial.hpp"

namespace zerocount::batch {

/// A sampling instant on the way, at which nothing changed: `passed` samples after the last that was
/// processed.
using PassedSample = std::function<void(double passed, double theta, const friction::CreepState& creep)>;

/// By the rest rule. A lane that is at rest goes on, by creep alone and in closed form, to the next stop, or
/// to the first sampling instant at which its count is another.
/// @param passed told of every sample before that one; may be empty.
/// @returns whether the lane was at rest; then it is at a stop.
bool rest(BatchState& batch, int lane, LaneTrial& trial, const PassedSample& passed);

/// Takes `samples` samples over, at which the error was 0 and the torque the same.
void pass_samples(BatchState& batch, int lane, double samples);

}  // namespace zerocount::batch
