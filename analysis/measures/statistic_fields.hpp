#pragma once

#include <vector>

#include "analysis/measures/point_statistics.hpp"
#include "analysis/text/report_field.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::measures {

/// One number of PointSummary as it is reported.
using StatisticField = text::ReportField<PointSummary>;

/// Those of a study with these features, in the order of the report: what only some studies have comes last.
std::vector<StatisticField> statistic_fields(const study::StudyFeatures& features = {},
                                             const layout::MeasureTable& measures = layout::measure_table());

/// The bounds of means, which are in summaries only: the results file does not hold them.
std::vector<StatisticField> mean_bound_fields(const layout::MeasureTable& measures = layout::measure_table());

/// What is reported of a torque level, in the order of the report.
using LevelField = text::ReportField<LevelStatistics>;
std::vector<LevelField> level_fields(const layout::MeasureTable& measures = layout::measure_table());

/// The qualities by which trials are counted in a study with these features, in the order of the report.
std::vector<const layout::Measure*> counted_qualities(const study::StudyFeatures& features,
                                                      const layout::MeasureTable& measures);

}  // namespace zerocount::measures
