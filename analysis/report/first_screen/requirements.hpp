#pragma once

#include <string>
#include <vector>

#include "analysis/report/reported_study.hpp"
#include "analysis/summary/cells_of_point.hpp"

namespace zerocount::report {

/// A goal in SI units: "±10 nm for good after 30 ms; true overshoot ≤ 1 µm; in 95 % of moves 0, 3 of 95 % of
/// the machines, with 95 % confidence".
std::string requirement_text(const study::Goal& goal, const study::Study& study);

/// Each goal under each condition at the chosen point: the verdict with its bounds, and what the moves do:
/// overshoot, peak torque, saturation. Without a goal the latter alone.
/// @param claims by goal and condition
std::string requirements_html(const ReportedStudy& reported, const std::vector<summary::CellOfPoint>& claims);

}  // namespace zerocount::report
