#pragma once

#include "experiments/study/study.hpp"

namespace zerocount::fuzz {

/// Computes the theory that `check` prints, of the first trial at the first and at the last design point. Not
/// of studies with many moves: it takes too long.
void use_theory(const study::Study& study);

}  // namespace zerocount::fuzz
