#pragma once

#include "analysis/statistics/moments.hpp"
#include "analysis/statistics/proportion.hpp"

namespace zerocount::statistics {

/// Student's t interval of a mean: with t the quantile of (1 + confidence)/2 for n − 1 degrees of freedom,
///
///   mean ± t·sd/√n,   in the values' unit.
///
/// Exact for normally distributed values; for other distributions the coverage approaches the stated
/// probability with growing n. NaN for fewer than two finite values.
/// @throws Failure (bad_input) for a confidence outside (0, 1).
ConfidenceInterval student_t(const Moments& sample, double confidence = summary_confidence);

}  // namespace zerocount::statistics
