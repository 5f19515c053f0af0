#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/comparison/comparison_report.hpp"
#include "analysis/history/series.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::history {
namespace {

std::string value_text(const Series& series, double value) {
  return comparison::value_text(value, series.measure, series.unit);
}

std::string bounds_text(const Series& series, const RunValue& value) {
  return fmt::format("[{}, {}]", value_text(series, value.bounds.low), value_text(series, value.bounds.high));
}

std::string name_of(const Series& series) {
  return text::printable(fmt::format("{}, {}, {}", series.study, series.point, series.measure));
}

using TableRows = std::vector<std::vector<std::string>>;

std::string table_of_series(const History& history) {
  TableRows rows{{"study", "point", "measure", "since", "runs", "first", "last", "95 % bounds", "changes"}};
  for (const Series& series : history.series) {
    const SeriesRun& first = series.runs.front();
    const SeriesRun& last = series.runs.back();
    rows.push_back({text::printable(series.study), text::printable(series.point),
                    text::printable(series.measure), text::printable(first.run.created.substr(0, 10)),
                    std::to_string(series.runs.size()), value_text(series, first.value.value),
                    value_text(series, last.value.value), bounds_text(series, last.value),
                    std::to_string(series.changes.size())});
  }
  return text::aligned_table(rows, {false, false, false, false, true, true, true, true, true});
}

std::string note_on(const Series& series, std::size_t run) {
  std::string note;
  for (const SeriesChange& change : series.changes) {
    if (change.first == run) note += "changed ";
    if (change.significant == run) note += "significant ";
  }
  return note.substr(0, note.size() - (note.empty() ? 0 : 1));
}

std::string table_of_runs(const Series& series) {
  TableRows rows{{"run", "commit", "seed", "trials", "value", "95 % bounds", "verdict", "change"}};
  for (std::size_t i = 0; i < series.runs.size(); ++i) {
    const auto& [run, value] = series.runs[i];
    rows.push_back({text::printable(run.created), text::printable(run.git_commit.substr(0, 10)),
                    text::printable(run.seed), std::to_string(run.trials), value_text(series, value.value),
                    bounds_text(series, value),
                    value.comparison ? text::printable(value.comparison->verdict) : "", note_on(series, i)});
  }
  return text::aligned_table(rows, {false, false, true, true, true, true, false, false});
}

std::string changes_text(const History& history) {
  std::string text;
  for (const Series& series : history.series) {
    for (const SeriesChange& change : series.changes)
      text += fmt::format("{}: {}\n", name_of(series), text::printable(change_sentence(series, change)));
  }
  return text.empty() ? "No change is significant.\n" : text;
}

}  // namespace

std::string history_text(const History& history) {
  std::string text = table_of_series(history);
  if (history.series.size() == 1) text += "\n" + table_of_runs(history.series.front());
  const std::string others =
      history.others.empty() ? ""
                             : fmt::format("Studies with a goal are judged by it; with --measure also: {}\n",
                                           fmt::join(history.others, ", "));
  return fmt::format("{}\n{}{}\n{}", text, changes_text(history), false_alarm_sentence(history), others);
}

}  // namespace zerocount::history
