#pragma once

#include <limits>

namespace zerocount::statistics {

/// The value of a statistic that is not known or not defined: NaN.
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace zerocount::statistics
