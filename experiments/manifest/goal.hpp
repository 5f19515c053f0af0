#pragma once

#include "experiments/manifest/values.hpp"

namespace zerocount::manifest {

/// Reads `verdict.bands`, the error bands of the study.
void read_bands(const yaml::Field& field, trial::ErrorBands& bands, yaml::Problems& problems);

/// Reads the goal of the study. Adds its band to those of the plan. The study's rigs and all parameters must
/// be read already.
void read_goal(const yaml::Field& field, Reading& reading);

}  // namespace zerocount::manifest
