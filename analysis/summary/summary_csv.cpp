#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/measures/point_columns.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/summary/summary.hpp"
#include "results/reading/csv.hpp"

namespace zerocount::summary {
namespace {

/// The subject of a line: a point, or one of its levels.
struct CsvSubject {
  std::size_t point{0};
  std::size_t level{0};
};

std::vector<CsvSubject> csv_subjects(const StudySummary& summary, const SummaryForm& form) {
  std::vector<CsvSubject> subjects;
  for (const std::int64_t index : points_shown(summary, form)) {
    const auto point = static_cast<std::size_t>(index);
    const std::size_t levels = summary.features.open_loop ? summary.points[point].levels.size() : 1;
    for (std::size_t level = 0; level < levels; ++level) subjects.push_back({point, level});
  }
  return subjects;
}

template <class Subject>
std::string field_text(const text::ReportField<Subject>& field, const Subject& subject) {
  const double value = field.value(subject);
  return field.whole ? std::to_string(static_cast<std::int64_t>(value)) : reading::number_text(value);
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) line += (line.empty() ? "" : ",") + reading::csv_field(cell);
  return line + "\n";
}

}  // namespace

std::string summary_csv(const StudySummary& summary, const SummaryForm& form) {
  require_consistent(summary);
  const std::vector<CsvSubject> subjects = csv_subjects(summary, form);
  std::vector<std::vector<std::string>> lines(subjects.size() + 1);
  const auto add = [&](const std::string& name, const auto& cell) {
    lines[0].push_back(name);
    for (std::size_t i = 0; i < subjects.size(); ++i) lines[i + 1].push_back(cell(subjects[i]));
  };
  const auto prediction_at = [&](std::size_t point) {
    return summary.predictions.empty() ? theory::PointPrediction{} : summary.predictions[point];
  };
  add("point", [](CsvSubject s) { return std::to_string(s.point); });
  add("label", [&](CsvSubject s) { return summary.labels[s.point]; });
  for (const study::SweepAxis& axis : summary.axes) {
    add(axis.name, [&](CsvSubject s) {
      return axis.kind == study::SweepAxis::Kind::text ? axis.texts[s.point]
                                                       : reading::number_text(axis.numbers[s.point]);
    });
  }
  if (summary.features.open_loop) {
    add("level", [](CsvSubject s) { return std::to_string(s.level); });
    for (const measures::LevelField& field : measures::level_fields(summary.table()))
      add(text::flat_name(field),
          [&](CsvSubject s) { return field_text(field, summary.points[s.point].levels[s.level]); });
  } else {
    for (const measures::StatisticField& field :
         measures::statistic_fields(summary.features, summary.table()))
      add(text::flat_name(field), [&](CsvSubject s) { return field_text(field, summary.points[s.point]); });
    for (const measures::PredictionField& field : measures::prediction_fields()) {
      add(std::string(field.name), [&](CsvSubject s) {
        const theory::PointPrediction prediction = prediction_at(s.point);
        return reading::number_text(
            statistics::rate(prediction.*field.trials, theory::predicted_trials(prediction)));
      });
    }
    add("predicted", [&](CsvSubject s) { return theory::verdict(prediction_at(s.point)); });
  }
  add("observed", [&](CsvSubject s) { return observed_at(summary, static_cast<std::int64_t>(s.point)); });
  for (const measures::SummarySection& section : summary.sections) {
    if (summary.features.open_loop) break;
    for (const layout::PointColumn& column : section.columns)
      add(column.name, [&](CsvSubject s) { return reading::number_text(column.values[s.point]); });
  }
  std::string text;
  for (const std::vector<std::string>& line : lines) text += csv_line(line);
  return text;
}

}  // namespace zerocount::summary
