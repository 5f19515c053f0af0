#pragma once

#include "experiments/manifest/values.hpp"

namespace zerocount::manifest {

/// Reads the stopping rule `stop`. The manifest's `trials` become the size of a block, and the study's number
/// of trials becomes the maximum.
void read_stop(const yaml::Field& field, Reading& reading);

}  // namespace zerocount::manifest
