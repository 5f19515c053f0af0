#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/measures/point_statistics.hpp"
#include "analysis/text/report_field.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::measures {

/// The statistics of all points as columns of the results file's /point: one for each of statistic_fields(),
/// by flat_name.
std::vector<layout::PointColumn> point_columns(
    std::span<const PointSummary> points, const study::StudyFeatures& features = {},
    const layout::MeasureTable& measures = layout::measure_table());

/// The levels of an open-loop study, of all its points, as the group /level of the results file: a column for
/// each of level_fields(), by flat_name.
layout::StatisticTable level_table(std::span<const PointSummary> points,
                                   const layout::MeasureTable& measures = layout::measure_table());

/// A reported proportion of trials by the criteria's prediction. The names are those in the CSV summary and
/// in the results file.
struct PredictionField {
  std::string_view name;
  std::string_view long_name;                     ///< with the denominator
  std::int64_t theory::PointPrediction::*trials;  ///< the trials in the numerator
};

/// Where (6) holds, and where (7) is exceeded.
std::span<const PredictionField> prediction_fields();

/// The proportions of prediction_fields() as columns of /point, NaN where the criteria are about no trial.
std::vector<layout::PointColumn> prediction_columns(std::span<const theory::PointPrediction> predictions);

/// The reverse of prediction_columns, [point]: the predictions behind the columns of those names, for points
/// with `trials` trials each.
/// @throws Failure (bad_data), with `file` in the message, where a column is missing or holds no proportions.
std::vector<theory::PointPrediction> predictions_of(std::span<const layout::PointColumn> columns,
                                                    std::int64_t trials, const std::filesystem::path& file);

/// One number of PointSummary as it is reported.
using StatisticField = text::ReportField<PointSummary>;

/// The fields of a study with these features, in the order of the report. Fields of some studies only come
/// last.
std::vector<StatisticField> statistic_fields(const study::StudyFeatures& features = {},
                                             const layout::MeasureTable& measures = layout::measure_table());

/// The bounds of means, which are in summaries only: the results file does not hold them.
std::vector<StatisticField> mean_bound_fields(const study::StudyFeatures& features,
                                              const layout::MeasureTable& measures = layout::measure_table());

/// The statistics reported of a torque level, in the order of the report.
using LevelField = text::ReportField<LevelStatistics>;
std::vector<LevelField> level_fields(const layout::MeasureTable& measures = layout::measure_table());

/// The qualities by which trials are counted in a study with these features, in the order of the report.
std::vector<const layout::Measure*> counted_qualities(const study::StudyFeatures& features,
                                                      const layout::MeasureTable& measures);

}  // namespace zerocount::measures
