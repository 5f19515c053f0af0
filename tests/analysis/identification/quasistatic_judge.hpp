#pragma once

#include "analysis/fit/record.hpp"
#include "core/friction/parameters.hpp"
#include "tests/analysis/identification/material_tests.hpp"

namespace zerocount::testing {

/// The rotor without inertia, by another formulation than core's: the spring as a sum of stop elements, creep
/// by small explicit steps, and a damper so weak that its torque may be that of the sample before.
///
/// @param damping c, N m s/rad.
/// @returns the readings of an encoder of that phase.
fit::TestRecord quasistatic_test(const friction::FrictionParameters& friction, double damping,
                                 const TorqueProgramme& programme, double counts_per_revolution,
                                 double phase);

}  // namespace zerocount::testing
