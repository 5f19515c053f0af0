#pragma once

#include "experiments/study/study.hpp"

namespace zerocount::fuzz {

/// Computes the theory that `check` prints for the first trial at the first and at the last design point.
/// Studies with many moves are skipped, because they take too long.
void use_theory(const study::Study& study);

}  // namespace zerocount::fuzz
