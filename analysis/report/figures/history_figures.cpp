#include <algorithm>

#include <fmt/format.h>

#include "analysis/report/figures/answer_figures.hpp"
#include "analysis/report/report_sections.hpp"

namespace zerocount::report {
namespace {

using history::Series;
using history::SeriesChange;
using history::SeriesRun;
std::string short_commit(const std::string& commit) {
  return commit.substr(0, 10);
}

FigureData runs_data(const Series& series) {
  return data_of<SeriesRun>(
      "runs", series.runs,
      {{{"date", "", ""}, [](const SeriesRun& one) { return one.run->created; }},
       {{"run", "run", ""}, [](const SeriesRun& one) { return one.run->created; }},
       {{"commit", "commit", ""}, [](const SeriesRun& one) { return short_commit(one.run->git_commit); }},
       {{"seed", "seed", ""}, [](const SeriesRun& one) { return one.run->seed; }},
       {{"trials", "trials per point", "1"}, [](const SeriesRun& one) { return one.run->trials; }},
       {{"value", series.measure, series.unit}, [](const SeriesRun& one) { return datum(one.value.value); }},
       {{"low", "lower 95 % bound", series.unit},
        [](const SeriesRun& one) { return datum(one.value.bounds.low); }},
       {{"high", "upper 95 % bound", series.unit},
        [](const SeriesRun& one) { return datum(one.value.bounds.high); }},
       {{"verdict", "against the baseline", ""}, [](const SeriesRun& one) {
          return one.value.comparison ? one.value.comparison->verdict : std::string();
        }}});
}

FigureData changes_data(const Series& series) {
  return data_of<SeriesChange>(
      "changes", series.changes,
      {{{"date", "", ""}, [&](const SeriesChange& one) { return series.runs[one.first].run->created; }},
       {{"commit", "", ""},
        [&](const SeriesChange& one) { return short_commit(series.runs[one.first].run->git_commit); }},
       {{"sentence", "", ""}, [](const SeriesChange& one) { return one.sentence; }}});
}

std::string caption_of(const Series& series) {
  std::string caption = fmt::format(
      "{} runs, with the 95 % bounds of each (bars){}. ", series.runs.size(),
      series.test == history::SeriesTest::baseline
          ? ". The runs share their random numbers, and so their errors; they are judged by their paired "
            "comparison with the baseline"
          : "");
  if (series.changes.empty()) return caption + "No change is significant. ";
  for (const SeriesChange& change : series.changes) caption += fmt::format("It {}. ", change.sentence);
  return caption + "A dashed line stands at the first run after a change, with its commit. ";
}

Figure history_figure(const Series& series, std::size_t number) {
  Figure figure = figure_of("history", fmt::format("history-{}", number),
                            fmt::format("{}, {}: {} over time", series.study, series.point, series.measure),
                            caption_of(series), {runs_data(series), changes_data(series)});
  if (series.runs.front().value.kind == statistics::MeasurementKind::proportion)
    figure.parameters["format"] = "~p";
  return figure;
}

std::vector<Figure> history_figures(const history::History& history, std::size_t max_figures) {
  std::vector<const Series*> ordered;
  for (const Series& series : history.series) ordered.push_back(&series);
  std::stable_partition(ordered.begin(), ordered.end(),
                        [](const Series* series) { return !series->changes.empty(); });
  ordered.resize(std::min(ordered.size(), max_figures));
  std::vector<Figure> figures;
  figures.reserve(ordered.size());
  for (const Series* const series : ordered) figures.push_back(history_figure(*series, figures.size() + 1));
  if (history.series.size() > max_figures && !figures.empty()) {
    figures.front().caption += fmt::format(
        "Figures stand here for {} of {} series, those that changed first. 'zerocount history plot' draws "
        "others with --study, --point and --measure. ",
        max_figures, history.series.size());
  }
  return figures;
}

}  // namespace

document::AnswerDescription<history::History> history_answer(std::size_t max_figures) {
  document::AnswerDescription<history::History> answer = history::history_answer();
  answer.items.figures(
      [max_figures](const history::History& history) { return history_figures(history, max_figures); });
  return answer;
}

PageSection history_section(const history::History& history, std::size_t max_figures) {
  if (history.series.empty())
    return {"history", "Over time", "<p>The history has fewer than two runs of this study.</p>\n", {}};
  return answer_section("history", "Over time", history_answer(max_figures).of(history));
}

}  // namespace zerocount::report
