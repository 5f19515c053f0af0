#pragma once

#include "experiments/keys/values.hpp"

namespace zerocount::sections {

/// Reads the parameter sections of the manifest `root`: the plan's list, its sequence and its base values,
/// and their places. Missing values get their defaults.
void read_sections(const yaml::Field& root, keys::Reading& reading, keys::PlanPlaces& places);

}  // namespace zerocount::sections
