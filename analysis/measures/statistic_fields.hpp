#pragma once

#include <span>

#include "analysis/measures/point_statistics.hpp"
#include "analysis/measures/study_features.hpp"
#include "analysis/text/report_field.hpp"

namespace zerocount {

/// One number of PointSummary as it is reported.
using StatisticField = ReportField<PointSummary>;

/// Those of a study with these features, in the order of the report: what only some studies have comes last.
std::span<const StatisticField> statistic_fields(const StudyFeatures& features = {});

/// The bounds of means, which are in summaries only: the results file does not hold them.
std::span<const StatisticField> mean_bound_fields();

/// The last of those that all studies have: those of the measures of the moves, without settling times and
/// jerks.
std::span<const StatisticField> measure_statistic_fields();

}  // namespace zerocount
