#pragma once

#include "experiments/manifest/values.hpp"

namespace zerocount::manifest {

/// Reads the key `correlation`, a list of entries [first parameter, second parameter, coefficient]:
/// plan.copula and study.correlations. Comes after the parameters and the sweep.
void read_correlations(const yaml::Field& root, Reading& reading);

}  // namespace zerocount::manifest
