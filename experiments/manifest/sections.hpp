#pragma once

#include "experiments/manifest/checks.hpp"
#include "experiments/manifest/values.hpp"

namespace zerocount::manifest {

/// Reads the parameter sections of the manifest `root`: the plan's list, its sequence and its base values,
/// and their places. Missing values get their defaults.
void read_sections(const yaml::Field& root, Reading& reading, PlanPlaces& places);

}  // namespace zerocount::manifest
