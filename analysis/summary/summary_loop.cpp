#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/percent.hpp"

namespace zerocount::summary {
namespace {

std::string interval_in_percent(const statistics::ConfidenceInterval& interval) {
  if (std::isnan(interval.low)) return "–";
  return fmt::format("[{}]", text::percent_bounds(interval.low, interval.high));
}

std::int64_t rigs_without_failure(const measures::PointSummary& point) {
  return std::llround(point.rigs.without_failure * static_cast<double>(point.rigs.n));
}

bool any_undecided(const StudySummary& summary) {
  return std::any_of(summary.points.begin(), summary.points.end(),
                     [](const measures::PointSummary& point) { return point.outcomes.off_target > 0; });
}

/// Trials that ended within one count and are not stable.
std::int64_t unsettled(const measures::PointSummary& point) {
  return point.outcomes.zero_count + point.outcomes.one_count - point.of(&trial::MoveOutcome::stable).trials;
}

/// Whether these are many enough at some point to have a column.
bool any_unsettled(const StudySummary& summary) {
  constexpr double min_proportion = 0.02;
  return std::any_of(summary.points.begin(), summary.points.end(), [](const measures::PointSummary& point) {
    return static_cast<double>(unsettled(point)) > min_proportion * static_cast<double>(point.judged);
  });
}

/// A column with a cell for each point.
template <typename Cell>
text::TextColumn by_point(const StudySummary& summary, std::string head, Cell cell) {
  text::TextColumn column{std::move(head), true, {}};
  for (const measures::PointSummary& point : summary.points) column.cells.push_back(cell(point));
  return column;
}

void add_outcomes(std::vector<text::TextColumn>& columns, const StudySummary& summary) {
  using Point = const measures::PointSummary&;
  columns.push_back(by_point(summary, "trials", [](Point p) { return fmt::format("{}", p.trials); }));
  columns.push_back(by_point(summary, "stable", [](Point p) {
    return text::percentage(p.of(&trial::MoveOutcome::stable).trials, p.judged);
  }));
  if (any_undecided(summary)) {
    columns.push_back(by_point(summary, "undecided",
                               [](Point p) { return text::percentage(p.outcomes.off_target, p.judged); }));
  }
  if (any_unsettled(summary)) {
    columns.push_back(
        by_point(summary, "unsettled", [](Point p) { return text::percentage(unsettled(p), p.judged); }));
  }
  columns.push_back(by_point(summary, "zero-count",
                             [](Point p) { return text::percentage(p.outcomes.zero_count, p.judged); }));
  columns.push_back(by_point(summary, bounds_head(summary),
                             [](Point p) { return interval_in_percent(p.success_rate().clopper_pearson); }));
  if (summary.features.rigs) {
    columns.push_back(by_point(summary, "rigs w/o failure",
                               [](Point p) { return text::percentage(rigs_without_failure(p), p.rigs.n); }));
  }
}

/// The measures of the table that have columns in this summary.
std::vector<const layout::Measure*> shown_measures(const StudySummary& summary) {
  std::vector<const layout::Measure*> shown =
      layout::measures_of(summary.table(), layout::ReportOrder::summary,
                          [](const layout::Measure& m) { return !m.summary.columns.empty(); });
  std::erase_if(shown, [&](const layout::Measure* m) {
    return m->summary.use != nullptr && !(summary.features.*m->summary.use);
  });
  return shown;
}

std::string cell_text(layout::CellText text, const measures::PointSummary& point, double value) {
  switch (text) {
    case layout::CellText::number:
      break;
    case layout::CellText::settling_time:
      return settling_text(point, value);
    case layout::CellText::proportion_of_trials:
      return text::percentage(std::llround(value), point.trials);
    case layout::CellText::proportion_of_moves:
      return text::percentage(std::llround(value), point.moves);
  }
  return text::short_number(value);
}

void add_measures(std::vector<text::TextColumn>& columns, const StudySummary& summary) {
  for (const layout::Measure* measure : shown_measures(summary)) {
    for (const layout::SummaryColumn& column : measure->summary.columns) {
      columns.push_back(by_point(summary, std::string(column.head), [&](const measures::PointSummary& point) {
        return cell_text(column.text, point, measures::value_of(column.statistic, point.of(*measure)));
      }));
    }
  }
}

/// The meaning of the columns of the measures that `belongs` picks.
std::string legend_of(const StudySummary& summary, bool (*belongs)(const layout::Measure&)) {
  std::string legend;
  for (const layout::Measure* measure : shown_measures(summary)) {
    if (belongs(*measure)) legend += measure->summary.legend;
  }
  return legend;
}

/// Whether the criteria (6) and (7) apply to any trial.
bool has_predictions(const StudySummary& summary) {
  return std::any_of(summary.predictions.begin(), summary.predictions.end(),
                     [](const theory::PointPrediction& one) { return theory::predicted_trials(one) > 0; });
}

void add_predictions(std::vector<text::TextColumn>& columns, const StudySummary& summary) {
  text::TextColumn holds{"(6) holds", true, {}}, exceeded{"(7) exceeded", true, {}};
  for (const theory::PointPrediction& prediction : summary.predictions) {
    holds.cells.push_back(text::percentage(prediction.stable, theory::predicted_trials(prediction)));
    exceeded.cells.push_back(text::percentage(prediction.unstable, theory::predicted_trials(prediction)));
  }
  columns.push_back(std::move(holds));
  columns.push_back(std::move(exceeded));
}

}  // namespace

std::string settling_text(const measures::PointSummary& point, double time) {
  if (!std::isnan(time) || point.of(&trial::MoveOutcome::settling_time).moves == 0)
    return text::short_number(time);
  return std::isnan(point.hold) ? "> hold" : fmt::format("> {} s", text::short_number(point.hold));
}

std::vector<text::TextColumn> loop_columns(const StudySummary& summary) {
  std::vector<text::TextColumn> columns = sweep_columns(summary);
  add_outcomes(columns, summary);
  add_measures(columns, summary);
  if (has_predictions(summary)) add_predictions(columns, summary);
  if (const std::vector<std::string> observed = observations(summary); !observed.empty()) {
    text::TextColumn column{"observed", false, {}};
    for (const std::string& text : observed) column.cells.push_back(text::printable(text));
    columns.push_back(std::move(column));
  }
  return columns;
}

/// Rigs that have trials; of an unfinished run, at the point with most of them.
std::int64_t rigs_of(const StudySummary& summary) {
  std::int64_t rigs = 0;
  for (const measures::PointSummary& point : summary.points) rigs = std::max(rigs, point.rigs.n);
  return rigs;
}

std::string design_line(const StudySummary& summary) {
  const study::StudyFeatures& features = summary.features;
  if (features.dependent_trials) {
    return "The trials of a saltelli design are not independent: all bounds here are too narrow. They are "
           "for\n"
           "'zerocount sensitivity'";
  }
  std::string line = fmt::format("design: {}", summary.design);
  if (features.rigs && !summary.points.empty()) {
    line += fmt::format(
        ", {} rigs: bounds are of all rigs that the manifest describes, and more trials on the same "
        "rigs\nnarrow them only so far",
        rigs_of(summary));
  }
  if (features.spread_trials) {
    line += fmt::format(
        "{} bounds are conservative: made for trials by chance, which vary more than those of this "
        "design",
        features.rigs ? ";" : ":");
  }
  return line;
}

std::string loop_legend(const StudySummary& summary) {
  const study::StudyFeatures& features = summary.features;
  std::string legend =
      "stable: proportion of trials whose moves all arrived and stayed within one count\n"
      "zero-count: proportion of trials whose moves all ended at zero error; bounds of it after " +
      std::string(features.rigs ? "Korn and Graubard" : "Clopper and Pearson") + ", in %\n" +
      legend_of(summary, [](const layout::Measure& m) { return m.summary.use == nullptr; });
  if (features.rigs)
    legend += "rigs w/o failure: proportion of rigs all of whose trials ended at zero error\n";
  if (any_undecided(summary)) {
    legend +=
        "undecided: proportion of trials whose worst move ended off target, stalled or still on its way: "
        "neither "
        "stable nor\nshown unstable\n";
  }
  if (any_unsettled(summary)) {
    legend +=
        "unsettled: proportion of trials that ended within one count without being stable: a move had not "
        "arrived "
        "yet, hunts by\none count, or had left by more than one; all other trials oscillated\n";
  }
  legend += legend_of(summary, layout::is_quality);
  legend += design_line(summary) + "\n";
  legend += legend_of(
      summary, [](const layout::Measure& m) { return m.summary.use != nullptr && !layout::is_quality(m); });
  if (has_predictions(summary)) {
    legend +=
        "(6), (7): proportion of trials in which the paper's criterion (6) holds, which promises stability "
        "before "
        "sliding, and\n"
        "in which its criterion (7) is exceeded, which rules it out; by the friction where the trial "
        "starts\n";
  }
  return legend;
}

}  // namespace zerocount::summary
