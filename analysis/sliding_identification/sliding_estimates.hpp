#pragma once

#include <vector>

#include "analysis/identification/identification.hpp"
#include "analysis/sliding_identification/sliding_fit.hpp"

namespace zerocount::sliding_identification {

constexpr double min_excess_ratio = 3.5;  ///< of the Stribeck excess to its standard error

/// The reported parameters with their 95 % intervals. What the fit has no parameter for, or knows too badly,
/// is not identifiable.
std::vector<identification::ParameterEstimate> estimates_of(const SlidingFit& fit, parameters::AxisKind axis);

}  // namespace zerocount::sliding_identification
