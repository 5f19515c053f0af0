#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/measures/point_statistics.hpp"
#include "analysis/summary/summary.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::summary {

/// The section "stopped" of the summary of a study that decided itself how many trials it took (`stop`): the
/// bounds of the success rate that hold although it looked after every block.
///
/// With rigs they are bounds of the mean over the rigs of the study, whose trials the rule is about: every
/// rig has run equally many at each look, and the product of the likelihood ratios of trials with different
/// probabilities pᵢ is no larger on average than that of trials which all have their mean (the geometric mean
/// is not above the arithmetic). How far other rigs differ, more trials on these do not tell.
///
/// Its JSON is {"success_rate_low", "success_rate_high", "confidence", "halfwidth", "halfwidth_asked",
/// "halfwidth_confidence", "reached", with rigs "of_rigs"}: what the rule asked for, at its own confidence,
/// and what was reached. Its columns are stopped_success_rate_low and stopped_success_rate_high; its text is
/// a table.
/// @param labels [point]
/// @param confidence of the bounds
measures::SummarySection stopping_section(std::span<const measures::PointSummary> points,
                                          const std::vector<std::string>& labels,
                                          const study::StoppingRule& rule, double confidence);

}  // namespace zerocount::summary
