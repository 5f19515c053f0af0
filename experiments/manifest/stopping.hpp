#pragma once

#include "experiments/study/study.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount {

/// Reads `stop` into the study: its rule, with blocks of the `trials` that the manifest states, and in place
/// of those trials the largest number of them.
/// @param most no study may have more trials at a point.
void read_stop(const Field& field, std::int64_t most, Study& study, Problems& problems);

}  // namespace zerocount
