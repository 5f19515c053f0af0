#pragma once

#include <string>
#include <vector>

#include "analysis/iso230/repeatability_statistics.hpp"
#include "analysis/measures/point_columns.hpp"

/// How a summary tells of the repeatability of a study with a sequence of moves.
namespace zerocount::iso230 {

/// The section "repeatability" of the summary.
///
/// Its JSON has the names of point_repeatability_fields(), and for each of deviation_sources() an object of
/// the unit, "axis" (axis_fields(), of each an object by value_statistic_fields()) and "targets" (an array,
/// of each target the number, its smallest and largest position in counts, and target_fields() alike). Its
/// columns have the same numbers by names such as "repeatability_true_accuracy_median" and
/// "repeatability_encoder_target_0_reversal_p95".
/// @param labels [point]
measures::SummarySection repeatability_section(const RepeatabilitySummary& summary,
                                               const std::vector<std::string>& labels);

/// Two tables for people, of the axis and of the targets: a row for each point (and target) and source, each
/// value as its median and 95 % quantile over the trials; a legend below.
std::string repeatability_tables(const RepeatabilitySummary& summary, const std::vector<std::string>& labels);

}  // namespace zerocount::iso230
