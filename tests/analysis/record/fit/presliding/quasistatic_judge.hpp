#pragma once

#include "analysis/record/fit/record.hpp"
#include "core/friction/parameters.hpp"
#include "tests/analysis/record/fit/presliding/material_tests.hpp"

namespace zerocount::testing {

/// A test of a rotor without inertia, simulated with another formulation than in core: the spring is a sum of
/// stop elements, creep is integrated by small explicit steps, and the damper is so weak that its torque may
/// lag by a sample.
///
/// @param damping c, N m s/rad
/// @returns the readings of an encoder with the given phase
fit::TestRecord quasistatic_test(const friction::FrictionParameters& friction, double damping,
                                 const TorqueProgramme& programme, double counts_per_revolution,
                                 double phase);

}  // namespace zerocount::testing
