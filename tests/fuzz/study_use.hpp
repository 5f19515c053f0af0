#pragma once

#include "experiments/study/study.hpp"

namespace zerocount::fuzz {

/// Computes what the commands `check` and `parameters` print of a study without running a trial: warnings,
/// labels, inputs and theory of some trials of the first and the last design point.
void use_study(const study::Study& study);

}  // namespace zerocount::fuzz
