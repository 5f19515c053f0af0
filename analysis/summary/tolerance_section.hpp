#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/measures/point_statistics.hpp"
#include "analysis/summary/summary.hpp"

namespace zerocount::summary {

/// The section "assurance" of a summary: what the trials of each point show of all axes that the manifest
/// describes, as tolerance statements.
///
/// Its JSON is {"success_at_least", "failure_at_most", "rule_of_three" (null where there was a failure),
/// "settling_time": [{"content", "within"}], "statement"}; its columns are success_at_least,
/// failure_at_most, settling_within_95, _99 and _99_9, and mean_bound_fields(); its text is a sentence for
/// each point.
/// @param labels [point]
measures::SummarySection tolerance_section(std::span<const measures::PointSummary> points,
                                           const std::vector<std::string>& labels);

}  // namespace zerocount::summary
