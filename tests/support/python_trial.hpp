#pragma once

#include <vector>

#include "core/trial/trial.hpp"

namespace zerocount::testing {

/// The samples of a trial by high_precision_trial.py: Gauss–Legendre collocation in 64-bit-mantissa
/// arithmetic.
/// @throws std::runtime_error where the script cannot be run or fails.
std::vector<trial::SampleRecord> python_trial(const trial::TrialParameters& parameters);

}  // namespace zerocount::testing
