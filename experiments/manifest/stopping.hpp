#pragma once

#include "experiments/study/study.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount::manifest {

/// Reads the stopping rule `stop`. The manifest's `trials` become the size of a block, and the study's number
/// of trials becomes the maximum.
/// @param max_trials upper limit of the trials at a point in any study
void read_stop(const yaml::Field& field, std::int64_t max_trials, study::Study& study,
               yaml::Problems& problems);

}  // namespace zerocount::manifest
