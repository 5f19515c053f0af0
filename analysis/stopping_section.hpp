#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/point_statistics.hpp"
#include "analysis/summary.hpp"
#include "experiments/study.hpp"

namespace zerocount {

/// The section "stopped" of the summary of a study that decided itself how many trials it took (`stop`): the
/// bounds of the success rate that hold although it looked after every block.
///
/// Its JSON is {"success_rate_low", "success_rate_high", "confidence", "halfwidth", "halfwidth_asked",
/// "halfwidth_confidence", "reached"}: what the rule asked for, at its own confidence, and what was reached.
/// Its columns are stopped_success_rate_low and stopped_success_rate_high; its text is a table.
/// @param labels [point]
/// @param confidence of the bounds
SummarySection stopping_section(std::span<const PointSummary> points, const std::vector<std::string>& labels,
                                const StoppingRule& rule, double confidence);

}  // namespace zerocount
