#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/measures/point_columns.hpp"
#include "analysis/measures/statistic_fields.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/summary/summary.hpp"
#include "results/reading/csv.hpp"

namespace zerocount {
namespace {

using Line = std::vector<std::string>;

/// The name of each column that tells the points apart, and their values at a point.
Line point_names(const StudySummary& summary) {
  Line names{"point", "label"};
  for (const SweepAxis& axis : summary.axes) names.push_back(axis.name);
  return names;
}
Line point_values(const StudySummary& summary, std::size_t point) {
  Line values{std::to_string(point), summary.labels[point]};
  for (const SweepAxis& axis : summary.axes) {
    values.push_back(axis.kind == SweepAxis::Kind::text ? axis.texts[point]
                                                        : number_text(axis.numbers[point]));
  }
  return values;
}

template <class Subject>
void add_names(Line& line, const std::vector<ReportField<Subject>>& fields) {
  for (const ReportField<Subject>& field : fields) line.push_back(flat_name(field));
}
template <class Subject>
void add_values(Line& line, const std::vector<ReportField<Subject>>& fields, const Subject& subject) {
  for (const ReportField<Subject>& field : fields) {
    const double value = field.value(subject);
    line.push_back(field.whole ? std::to_string(static_cast<std::int64_t>(value)) : number_text(value));
  }
}

Line csv_header(const StudySummary& summary, const std::vector<StatisticField>& fields) {
  Line header = point_names(summary);
  add_names(header, fields);
  for (const PredictionField& field : prediction_fields()) header.emplace_back(field.name);
  header.insert(header.end(), {"predicted", "observed"});
  for (const SummarySection& section : summary.sections) {
    for (const PointColumn& column : section.columns) header.push_back(column.name);
  }
  return header;
}

Line csv_row(const StudySummary& summary, const std::vector<StatisticField>& fields, std::size_t point) {
  Line row = point_values(summary, point);
  add_values(row, fields, summary.points[point]);
  const TheoryPrediction prediction =
      summary.predictions.empty() ? TheoryPrediction{} : summary.predictions[point];
  for (const PredictionField& field : prediction_fields()) {
    row.push_back(number_text(rate(prediction.*field.trials, predicted_trials(prediction))));
  }
  row.push_back(verdict(prediction));
  row.push_back(observed_at(summary, static_cast<std::int64_t>(point)));
  for (const SummarySection& section : summary.sections) {
    for (const PointColumn& column : section.columns) row.push_back(number_text(column.values[point]));
  }
  return row;
}

Line level_header(const StudySummary& summary, const std::vector<LevelField>& fields) {
  Line header = point_names(summary);
  header.emplace_back("level");
  add_names(header, fields);
  header.emplace_back("observed");
  return header;
}

Line level_row(const StudySummary& summary, const std::vector<LevelField>& fields, std::size_t point,
               std::size_t level) {
  Line row = point_values(summary, point);
  row.push_back(std::to_string(level));
  add_values(row, fields, summary.points[point].levels[level]);
  row.push_back(observed_at(summary, static_cast<std::int64_t>(point)));
  return row;
}

std::string csv_line(const Line& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) line += ',';
    line += csv_field(fields[i]);
  }
  return line + "\n";
}

std::string levels_csv(const StudySummary& summary) {
  const std::vector<LevelField> fields = level_fields(summary.table());
  std::string text = csv_line(level_header(summary, fields));
  for (std::size_t point = 0; point < summary.points.size(); ++point) {
    for (std::size_t level = 0; level < summary.points[point].levels.size(); ++level) {
      text += csv_line(level_row(summary, fields, point, level));
    }
  }
  return text;
}

}  // namespace

std::string summary_csv(const StudySummary& summary) {
  require_consistent(summary);
  if (summary.features.open_loop) return levels_csv(summary);
  const std::vector<StatisticField> fields = statistic_fields(summary.features, summary.table());
  std::string text = csv_line(csv_header(summary, fields));
  for (std::size_t i = 0; i < summary.points.size(); ++i) text += csv_line(csv_row(summary, fields, i));
  return text;
}

}  // namespace zerocount
