#pragma once

#include <vector>

#include "analysis/measures/point_statistics.hpp"
#include "analysis/text/report_field.hpp"
#include "experiments/study/study_features.hpp"

namespace zerocount {

/// One number of PointSummary as it is reported.
using StatisticField = ReportField<PointSummary>;

/// Those of a study with these features, in the order of the report: what only some studies have comes last.
std::vector<StatisticField> statistic_fields(const StudyFeatures& features = {},
                                             const MeasureTable& measures = measure_table());

/// The bounds of means, which are in summaries only: the results file does not hold them.
std::vector<StatisticField> mean_bound_fields(const MeasureTable& measures = measure_table());

/// What is reported of a torque level, in the order of the report.
using LevelField = ReportField<LevelStatistics>;
std::vector<LevelField> level_fields(const MeasureTable& measures = measure_table());

/// The qualities by which trials are counted in a study with these features, in the order of the report.
std::vector<const Measure*> counted_qualities(const StudyFeatures& features, const MeasureTable& measures);

}  // namespace zerocount
