#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/document/description.hpp"
#include "analysis/basis/text/report_field.hpp"
#include "analysis/trials/measures/point_statistics.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "experiments/parameters/study_units.hpp"
#include "experiments/study/features.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::measures {

/// The statistics of all points as columns of the group /point of the results file: one column for each of
/// statistic_fields(), named by flat_name().
std::vector<layout::PointColumn> point_columns(
    std::span<const PointSummary> points, const study::StudyFeatures& features = {},
    const layout::MeasureTable& measures = layout::measure_table());

/// The statistics of the torque levels of all points of an open-loop study, as the table of the group /level
/// of the results file: one column for each of level_fields(), named by flat_name().
layout::StatisticTable level_table(std::span<const PointSummary> points,
                                   const layout::MeasureTable& measures = layout::measure_table());

/// A reported proportion of trials for which the analytical criteria of the paper predict something.
struct PredictionField {
  std::string_view name;       ///< Name of the proportion in the CSV summary and in the results file.
  std::string_view long_name;  ///< Meaning of the proportion, including its denominator.
  std::int64_t theory::PointPrediction::*trials;  ///< Member that counts the trials in the numerator.
};

/// The two reported proportions: of trials in which the paper's stability criterion (6) holds, and of trials
/// in which its criterion (7) is exceeded.
std::span<const PredictionField> prediction_fields();

/// The two proportions of prediction_fields() for all design points, as columns of the group /point of the
/// results file; NaN if the paper's criteria apply to no trial.
std::vector<layout::PointColumn> prediction_columns(std::span<const theory::PointPrediction> predictions);

/// [point] the predictions behind the columns that prediction_columns() wrote (its inverse), for points with
/// `trials` trials each.
/// @throws Failure (bad_data), with `file` in the message, if a column is missing or holds other values than
/// proportions.
std::vector<theory::PointPrediction> predictions_of(std::span<const layout::PointColumn> columns,
                                                    std::int64_t trials, const std::filesystem::path& file);

/// One reported number of a design point, such as its success rate.
using StatisticField = text::ReportField<PointSummary>;

/// The reported numbers of a design point for a study with these features, in the order of the report.
/// Numbers that only some studies have come last.
std::vector<StatisticField> statistic_fields(const study::StudyFeatures& features = {},
                                             const layout::MeasureTable& measures = layout::measure_table());

/// The bounds of means as reported numbers of a design point. Only summaries have them; the results file does
/// not.
std::vector<StatisticField> mean_bound_fields(const study::StudyFeatures& features,
                                              const layout::MeasureTable& measures = layout::measure_table());

/// One reported statistic of a torque level of an open-loop study.
using LevelField = text::ReportField<LevelStatistics>;
/// The reported statistics of a torque level of an open-loop study, in the order of the report.
std::vector<LevelField> level_fields(const layout::MeasureTable& measures = layout::measure_table());

/// The qualities, such as success, by which trials are counted in a study with these features, in the order
/// of the report.
std::vector<const layout::Measure*> counted_qualities(const study::StudyFeatures& features,
                                                      const layout::MeasureTable& measures);

/// Adds one reported number to the description of an answer as a value.
/// @param subject_of function that returns a reference to the subject (such as a PointSummary) of a row
template <class Row, class Subject, class Get>
void add_field(document::Description<Row>& description, const text::ReportField<Subject>& field,
               const std::string& key, parameters::AxisKind axis, document::Visibility shown,
               Get subject_of) {
  document::Item item{.key = key,
                      .meaning = parameters::text_on(axis, field.long_name),
                      .unit = parameters::unit_on(axis, field.unit),
                      .shown = shown};
  if (!field.whole) {
    description.value(std::move(item),
                      [value = field.value, subject_of](const Row& row) { return value(subject_of(row)); });
    return;
  }
  description.value(std::move(item),
                    [value = field.value, subject_of](const Row& row) -> std::optional<std::int64_t> {
                      const double number = value(subject_of(row));
                      if (std::isnan(number)) return std::nullopt;
                      return static_cast<std::int64_t>(number);
                    });
}

/// Adds reported numbers to the description of an answer. The numbers of a group form an object, so that
/// their names in CSV equal flat_name().
/// @param subject_of function that returns a reference to the subject of a row
template <class Row, class Subject, class Get>
void add_fields(document::Description<Row>& description,
                const std::vector<text::ReportField<Subject>>& fields, parameters::AxisKind axis,
                Get subject_of) {
  using Field = text::ReportField<Subject>;
  std::vector<std::string> groups;
  for (const Field& field : fields) {
    if (field.group.empty()) {
      add_field(description, field, field.name, axis, document::Visibility::in_data, subject_of);
      continue;
    }
    if (std::ranges::find(groups, field.group) != groups.end()) continue;
    groups.push_back(field.group);
    document::Description<Subject> group;
    for (const Field& member : fields) {
      if (member.group != field.group) continue;
      add_field(group, member, member.name, axis, document::Visibility::in_data,
                [](const Subject& subject) -> const Subject& { return subject; });
    }
    std::string meaning = "statistics of " + field.group;
    std::ranges::replace(meaning, '_', ' ');
    description.object(
        {.key = field.group, .meaning = std::move(meaning), .shown = document::Visibility::in_data},
        std::move(group), subject_of);
  }
}

/// One row of a LimitList: a subject (such as a PointSummary) and one of its error bands or tolerances.
template <class Subject>
struct LimitEntry {
  const Subject& subject;
  std::size_t limit;  ///< Index of the error band or tolerance, in rising order of their sizes.
};

/// The items that describe a list in an answer with one row for each error band, or each tolerance.
struct LimitList {
  document::Item list;   ///< Item of the list itself: "bands".
  document::Item limit;  ///< Item for the size of the band or tolerance in each row of the list: "band".
};

inline LimitList list_of_bands() {
  return {{.key = "bands", .meaning = "statistics by error band", .shown = document::Visibility::in_json},
          {.key = "band", .meaning = "largest error of the band", .unit = "count"}};
}
inline LimitList list_of_tolerances(parameters::AxisKind axis) {
  return {{.key = "tolerances",
           .meaning = "statistics by tolerance of the position error",
           .shown = document::Visibility::in_json},
          {.key = "tolerance",
           .meaning = "largest position error within the tolerance",
           .unit = parameters::unit_on(axis, "rad")}};
}

/// Adds the reported numbers of error bands, or of tolerances, to the description of an answer: a list in
/// JSON, columns named by flat_name() in CSV.
template <class Row, class Subject, class Get>
void add_by_limit(document::Description<Row>& description,
                  const std::vector<text::ReportField<Subject>>& fields, LimitList list,
                  parameters::AxisKind axis, Get subject_of) {
  using Entry = LimitEntry<Subject>;
  std::map<double, std::vector<text::ReportField<Subject>>> by_limit;
  for (const text::ReportField<Subject>& field : fields)
    by_limit[text::limit_of(field).value()].push_back(field);
  if (by_limit.empty()) return;
  const auto limits =
      std::make_shared<const std::vector<std::pair<double, std::vector<text::ReportField<Subject>>>>>(
          by_limit.begin(), by_limit.end());
  std::vector<text::ReportField<Entry>> columns;
  for (std::size_t i = 0; i < limits->front().second.size(); ++i) {
    const text::ReportField<Subject>& first = limits->front().second[i];
    columns.push_back({first.group, first.name, first.unit, first.long_name, first.whole,
                       [limits, i](const Entry& reading) {
                         return (*limits)[reading.limit].second.at(i).value(reading.subject);
                       }});
  }
  document::Description<Entry> row;
  if (fields.front().band) {
    row.value(std::move(list.limit), [limits](const Entry& reading) {
      return static_cast<std::int64_t>((*limits)[reading.limit].first);
    });
  } else {
    row.value(std::move(list.limit),
              [limits](const Entry& reading) { return (*limits)[reading.limit].first; });
  }
  add_fields(row, columns, axis, [](const Entry& reading) -> const Entry& { return reading; });
  description.table(std::move(list.list), std::move(row),
                    [number = limits->size(), subject_of](const Row& of) {
                      std::vector<Entry> readings;
                      for (std::size_t limit = 0; limit < number; ++limit)
                        readings.push_back({subject_of(of), limit});
                      return readings;
                    });
  for (const text::ReportField<Subject>& field : fields)
    add_field(description, field, text::flat_name(field), axis, document::Visibility::in_csv, subject_of);
}

}  // namespace zerocount::measures
