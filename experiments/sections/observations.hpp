#pragma once

#include <vector>

#include "experiments/sections/sweep.hpp"

namespace zerocount::sections {

/// Reads `observed`, a map from cases or point labels to observations on a real rig: study.observed and
/// study.observed_counts. An observation is a text, or counts: {successes: 9, of: 10, text: what else}. That
/// of a case applies to all its points, except those with one of their own.
/// @param axes of the sweep, complete
void read_observations(const yaml::Field& field, const std::vector<SweptAxis>& axes, keys::Reading& reading);

}  // namespace zerocount::sections
