#pragma once

#include <string>

#include "analysis/measures/point_statistics.hpp"

namespace zerocount::summary {

/// A quantile of the settling time, or a bound of it, as text: four significant digits, "> 1 s" where it is
/// not reached within the hold, "> hold" where trials differ in theirs, "–" where there is no move with a
/// target.
/// @param time of `point`, s; NaN where not reached
std::string settling_text(const measures::PointSummary& point, double time);

}  // namespace zerocount::summary
