#pragma once

#include "experiments/manifest/checks.hpp"
#include "experiments/manifest/values.hpp"

namespace zerocount::manifest {

/// Lets the parameters that follow from measured ones (parameters/measured_parameters.hpp) do so, where the
/// study gives the measured ones. Reports a group that is not complete, and one beside parameters that follow
/// from it. Must come after all values are read.
void let_follow_from_measured(const PlanPlaces& places, Reading& reading);

/// Reports measured values from which nothing allowed follows.
void check_what_follows(const PlanPlaces& places, Reading& reading);

}  // namespace zerocount::manifest
