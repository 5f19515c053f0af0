#pragma once

#include "experiments/manifest/values.hpp"

namespace zerocount::manifest {

/// Reads `tune`. The study's goal and all parameters must be read already.
void read_tuning(const yaml::Field& field, Reading& reading);

}  // namespace zerocount::manifest
