#pragma once

#include "experiments/manifest/checks.hpp"
#include "experiments/manifest/values.hpp"

namespace zerocount {

/// Reads the parameter sections of the manifest `root`: the plan's list, its sequence and its base values,
/// and their places. Missing values get their defaults.
void read_sections(const Field& root, Reading& reading, PlanPlaces& places);

}  // namespace zerocount
