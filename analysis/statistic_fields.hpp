#pragma once

#include <span>

#include "analysis/point_statistics.hpp"
#include "analysis/report_field.hpp"

namespace zerocount {

/// One number of PointSummary as it is reported.
using StatisticField = ReportField<PointSummary>;

/// All of them, in the order of the report.
std::span<const StatisticField> statistic_fields();

/// The last of them: those of the measures of the moves, without settling times and jerks.
std::span<const StatisticField> measure_statistic_fields();

}  // namespace zerocount
