#pragma once

#include <string>

#include "analysis/measures/point_statistics.hpp"

namespace zerocount::summary_answer {

/// A quantile of the settling times of all moves of a point, or a bound of it, as text: four significant
/// digits, "> 1 s" if it is not reached within the hold, "> hold" if trials differ in theirs, "–" if there is
/// no move with a target.
/// @param time s; NaN if not reached
std::string settling_text(const measures::PointSummary& point, double time);

}  // namespace zerocount::summary_answer
