#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/point_columns.hpp"
#include "analysis/proportion.hpp"
#include "analysis/statistic_fields.hpp"
#include "analysis/summary.hpp"
#include "results/reading/csv.hpp"

namespace zerocount {
namespace {

std::vector<std::string> csv_header(const StudySummary& summary) {
  std::vector<std::string> header{"point", "label"};
  for (const SweepAxis& axis : summary.axes) header.push_back(axis.name);
  for (const StatisticField& field : statistic_fields()) header.push_back(flat_name(field));
  for (const PredictionField& field : prediction_fields()) header.emplace_back(field.name);
  header.insert(header.end(), {"predicted", "observed"});
  return header;
}

std::vector<std::string> csv_row(const StudySummary& summary, std::size_t point) {
  std::vector<std::string> row{std::to_string(point), summary.labels[point]};
  for (const SweepAxis& axis : summary.axes) {
    row.push_back(axis.kind == SweepAxis::Kind::text ? axis.texts[point] : number_text(axis.numbers[point]));
  }
  for (const StatisticField& field : statistic_fields()) {
    const double value = field.value(summary.points[point]);
    row.push_back(field.whole ? std::to_string(static_cast<std::int64_t>(value)) : number_text(value));
  }
  const TheoryPrediction prediction =
      summary.predictions.empty() ? TheoryPrediction{} : summary.predictions[point];
  for (const PredictionField& field : prediction_fields()) {
    row.push_back(number_text(rate(prediction.*field.trials, prediction.trials)));
  }
  row.push_back(verdict(prediction));
  row.push_back(observed_at(summary, static_cast<std::int64_t>(point)));
  return row;
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) line += ',';
    line += csv_field(fields[i]);
  }
  return line + "\n";
}

}  // namespace

std::string summary_csv(const StudySummary& summary) {
  require_consistent(summary);
  std::string text = csv_line(csv_header(summary));
  for (std::size_t i = 0; i < summary.points.size(); ++i) text += csv_line(csv_row(summary, i));
  return text;
}

}  // namespace zerocount
