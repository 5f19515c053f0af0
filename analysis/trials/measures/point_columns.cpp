#include "analysis/trials/measures/point_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/statistics/proportion.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::measures {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, std::string_view column, const std::string& what) {
  throw Failure(ExitCode::bad_data, fmt::format("{}: damaged: /point/{}: {}", file.string(), column, what));
}

const layout::PointColumn& find_column(std::span<const layout::PointColumn> columns, std::string_view name,
                                       const std::filesystem::path& file) {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [name](const layout::PointColumn& column) { return column.name == name; });
  if (found == columns.end()) fail(file, name, "the dataset is missing");
  return *found;
}

/// Converts a proportion of trials back to their number.
/// @param trials number of all trials
/// @param name name of the column, for the message
/// @throws Failure (bad_data) if the value is not the proportion of a whole number of trials
std::int64_t trials_of_proportion(double proportion, std::int64_t trials, std::string_view name,
                                  const std::filesystem::path& file) {
  if (!(proportion >= 0.0 && proportion <= 1.0))
    fail(file, name, fmt::format("{} is not a proportion of trials", proportion));
  return std::llround(proportion * static_cast<double>(trials));
}

}  // namespace

std::vector<layout::PointColumn> point_columns(std::span<const PointSummary> points,
                                               const study::StudyFeatures& features,
                                               const layout::MeasureTable& measures) {
  std::vector<layout::PointColumn> columns;
  for (const StatisticField& field : statistic_fields(features, measures)) {
    layout::PointColumn& column =
        columns.emplace_back(layout::PointColumn{text::flat_name(field), field.unit, field.long_name, {}});
    for (const PointSummary& point : points) column.values.push_back(field.value(point));
  }
  return columns;
}

layout::StatisticTable level_table(std::span<const PointSummary> points,
                                   const layout::MeasureTable& measures) {
  layout::StatisticTable table{
      &layout::level_group(), points.empty() ? 1 : std::ssize(points.front().levels), {}};
  for (const LevelField& field : level_fields(measures)) {
    layout::PointColumn& column = table.columns.emplace_back(
        layout::PointColumn{text::flat_name(field), field.unit, field.long_name, {}});
    for (const PointSummary& point : points) {
      for (const LevelStatistics& level : point.levels) column.values.push_back(field.value(level));
    }
  }
  return table;
}

std::span<const PredictionField> prediction_fields() {
  static constexpr std::array<PredictionField, 2> fields{
      {{"predicted_stable_share", "trials in which criterion (6) holds, as a proportion of trials",
        &theory::PointPrediction::stable},
       {"predicted_unstable_share", "trials in which criterion (7) is exceeded, as a proportion of trials",
        &theory::PointPrediction::unstable}}};
  return fields;
}

std::vector<layout::PointColumn> prediction_columns(std::span<const theory::PointPrediction> predictions) {
  std::vector<layout::PointColumn> columns;
  for (const PredictionField& field : prediction_fields()) {
    layout::PointColumn column{std::string(field.name), "1", std::string(field.long_name), {}};
    for (const theory::PointPrediction& prediction : predictions) {
      column.values.push_back(
          statistics::rate(prediction.*field.trials, theory::predicted_trials(prediction)));
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

std::vector<theory::PointPrediction> predictions_of(std::span<const layout::PointColumn> columns,
                                                    std::int64_t trials, const std::filesystem::path& file) {
  std::vector<theory::PointPrediction> predictions;
  for (const PredictionField& field : prediction_fields()) {
    const std::vector<double>& proportions = find_column(columns, field.name, file).values;
    predictions.resize(proportions.size(), {trials, 0, 0, 0});
    for (std::size_t point = 0; point < proportions.size(); ++point) {
      if (std::isnan(proportions[point])) {
        predictions[point].outside = trials;
      } else {
        predictions[point].*field.trials = trials_of_proportion(proportions[point], trials, field.name, file);
      }
    }
  }
  return predictions;
}

}  // namespace zerocount::measures
