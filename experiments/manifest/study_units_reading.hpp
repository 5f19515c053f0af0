#pragma once

#include "experiments/manifest/values.hpp"

namespace zerocount {

/// Reads what decides the units of all other values: `axis`, `travel` and `controller.units` of the manifest
/// `root` to the plan's units and period. To be done first.
void read_study_units(const Field& root, Reading& reading);

/// Warns where `travel` is given and nothing varies along it.
void check_travel(const Field& root, Reading& reading);

}  // namespace zerocount
