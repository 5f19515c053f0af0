#pragma once

#include "experiments/manifest/values.hpp"

namespace zerocount::manifest {

/// Reads `axis`, `travel` and `controller.units` of the manifest `root` into the plan's units and period.
/// Must be called first, because all other values depend on the units.
void read_study_units(const yaml::Field& root, Reading& reading);

/// Warns if `travel` is given and nothing varies along it.
void check_travel(const yaml::Field& root, Reading& reading);

}  // namespace zerocount::manifest
