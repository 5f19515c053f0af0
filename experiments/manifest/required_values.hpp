#pragma once

#include "experiments/manifest/checks.hpp"
#include "experiments/manifest/values.hpp"

namespace zerocount::manifest {

/// Reports missing required parameters: those without a default, and those whose default has other units than
/// this study (such as the paper's N m/rad on a linear axis), if they have an effect.
void check_required_values(const PlanPlaces& places, Reading& reading);

}  // namespace zerocount::manifest
