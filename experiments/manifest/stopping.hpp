#pragma once

#include "experiments/study/study.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount {

/// Reads the stopping rule `stop`. The manifest's `trials` become the size of a block, and the study's number
/// of trials becomes the maximum.
/// @param max_trials upper limit of the trials at a point in any study
void read_stop(const Field& field, std::int64_t max_trials, Study& study, Problems& problems);

}  // namespace zerocount
