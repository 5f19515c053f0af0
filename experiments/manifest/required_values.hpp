#pragma once

#include "experiments/manifest/checks.hpp"
#include "experiments/manifest/values.hpp"

namespace zerocount {

/// Reports the parameters that have to be given in the units of this study: those without a default, and
/// those whose default is in other units, such as the paper's N m/rad on a linear axis, wherever they have an
/// effect.
void check_required_values(const PlanPlaces& places, Reading& reading);

}  // namespace zerocount
