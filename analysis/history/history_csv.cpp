#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/history/series.hpp"
#include "results/reading/csv.hpp"

namespace zerocount::history {
namespace {

std::string line_of(const Series& series, std::size_t i) {
  const auto number = [](double value) { return reading::number_text(value); };
  const auto& [run, value] = series.runs[i];
  const ValueComparison compared = value.comparison.value_or(ValueComparison{});
  std::vector<std::string> cells{series.study,
                                 series.series_sha256,
                                 run.study_sha256,
                                 series.point,
                                 series.measure,
                                 series.unit,
                                 run.created,
                                 run.git_commit,
                                 run.seed,
                                 std::to_string(run.trials),
                                 std::to_string(value.n),
                                 number(value.value),
                                 number(value.bounds.low),
                                 number(value.bounds.high),
                                 compared.verdict,
                                 number(compared.effect),
                                 number(compared.bounds.low),
                                 number(compared.bounds.high),
                                 number(compared.p)};
  const auto count = [&](std::size_t SeriesChange::*at) {
    return std::to_string(std::ranges::count(series.changes, i, at));
  };
  cells.push_back(count(&SeriesChange::first));
  cells.push_back(count(&SeriesChange::significant));
  for (std::string& cell : cells) cell = reading::csv_field(cell);
  return fmt::format("{}\n", fmt::join(cells, ","));
}

}  // namespace

std::string history_csv(const History& history) {
  std::string text =
      "study,series_sha256,study_sha256,point,measure,unit,created,git_commit,seed,trials,n,value,low,high,"
      "verdict,"
      "effect,effect_low,effect_high,p,changed,significant\n";
  for (const Series& series : history.series) {
    for (std::size_t i = 0; i < series.runs.size(); ++i) text += line_of(series, i);
  }
  return text;
}

}  // namespace zerocount::history
