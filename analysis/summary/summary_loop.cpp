#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "analysis/goal/goal_text.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/percent.hpp"

namespace zerocount::summary {
namespace {

std::string interval_in_percent(const statistics::ConfidenceInterval& interval) {
  if (std::isnan(interval.low)) return "–";
  return fmt::format("[{}]", text::percent_bounds(interval.low, interval.high));
}

/// Whether some point of the table `is` so.
template <typename Is>
bool any_point(const StudySummary& summary, Is is) {
  return std::ranges::any_of(complete_points(summary), [&](std::int64_t point) {
    return is(summary.points[static_cast<std::size_t>(point)]);
  });
}

bool any_undecided(const StudySummary& summary) {
  return any_point(summary,
                   [](const measures::PointSummary& point) { return point.outcomes.off_target > 0; });
}

/// What keeps a trial from being stable, by its worst move. With the stable trials and the undecided ones,
/// which ended off target, these are all.
struct NotStable {
  const char* head;
  std::int64_t (*trials)(const measures::PointSummary& point);
  const char* legend;
};

constexpr std::array<NotStable, 2> not_stable{
    {{"in jerks",
      [](const measures::PointSummary& p) {
        return p.outcomes.zero_count + p.outcomes.one_count - p.of(&trial::MoveOutcome::stable).trials;
      },
      "in jerks: proportion of trials that ended within one count, but not stable: a move was still creeping "
      "in "
      "jerks, which kept the error from being zero for a dwell or carried it beyond one count after that, or "
      "it hunts by one count; a longer hold tells which\n"},
     {"oscillates",
      [](const measures::PointSummary& p) { return p.outcomes.oscillating + p.outcomes.nonfinite; },
      "oscillates: proportion of trials with a move whose error still swung by more than one count at its "
      "end, "
      "or that was lost\n"}}};

/// Whether these are many enough at some point to have a column.
bool is_shown(const StudySummary& summary, const NotStable& reason) {
  constexpr double min_proportion = 0.02;
  return any_point(summary, [&](const measures::PointSummary& point) {
    return static_cast<double>(reason.trials(point)) > min_proportion * static_cast<double>(point.judged);
  });
}

/// With one trial per rig, rigs without a failure are the trials without one.
bool has_several_trials_of_rigs(const StudySummary& summary) {
  return any_point(summary, [](const measures::PointSummary& point) {
    return point.rigs.n > 0 && point.trials > point.rigs.n;
  });
}

/// A column with a cell for each point.
template <typename Cell>
text::TextColumn by_point(const StudySummary& summary, std::string head, Cell cell) {
  text::TextColumn column{std::move(head), true, {}};
  for (const std::int64_t point : complete_points(summary))
    column.cells.push_back(cell(summary.points[static_cast<std::size_t>(point)]));
  return column;
}

/// "98.2 %" and "[97.1, 98.9]" of each point, in two columns.
void add_proportion(std::vector<text::TextColumn>& columns, const std::string& head,
                    std::span<const std::optional<goal::Verdict>> verdicts,
                    goal::BoundedProportion goal::Verdict::*proportion) {
  text::TextColumn values{head, true, {}}, bounds{"bounds", true, {}};
  for (const std::optional<goal::Verdict>& verdict : verdicts) {
    const goal::BoundedProportion shown = verdict ? (*verdict).*proportion : goal::BoundedProportion{};
    values.cells.push_back(verdict ? text::percent_near(shown.value) : "–");
    bounds.cells.push_back(verdict ? fmt::format("[{}]", text::percent_bounds(shown.low, shown.high)) : "–");
  }
  columns.push_back(std::move(values));
  columns.push_back(std::move(bounds));
}

void add_goal(std::vector<text::TextColumn>& columns, const StudySummary& summary) {
  const std::vector<std::optional<goal::Verdict>> verdicts = goal_verdicts(summary);
  const std::string where = goal::is_of_worst_world(summary.question) ? " (worst world)" : "";
  text::TextColumn status{"goal", false, {}};
  for (const std::optional<goal::Verdict>& verdict : verdicts)
    status.cells.emplace_back(verdict ? goal::text_of(verdict->status) : "–");
  columns.push_back(std::move(status));
  if (summary.question.claim()->machines)
    add_proportion(columns, "machines in goal" + where, verdicts, &goal::Verdict::machines);
  add_proportion(columns, "moves in goal" + where, verdicts, &goal::Verdict::moves);
}

/// Rigs without a failure by the question.
void add_rigs(std::vector<text::TextColumn>& columns, const StudySummary& summary,
              const goal::Question& question) {
  if (!has_several_trials_of_rigs(summary)) return;
  columns.push_back(
      by_point(summary, std::string(words_of(question).rig_head), [&](const measures::PointSummary& point) {
        const goal::RigsWithoutFailure rigs = rigs_without_failure(question, point);
        return text::percentage(rigs.rigs, rigs.of);
      }));
}

void add_success(std::vector<text::TextColumn>& columns, const StudySummary& summary) {
  columns.push_back(by_point(summary, "zero-count", [](const measures::PointSummary& p) {
    return text::percentage(p.outcomes.zero_count, p.judged);
  }));
  columns.push_back(by_point(summary, bounds_head(summary), [](const measures::PointSummary& p) {
    return interval_in_percent(p.success_rate().clopper_pearson);
  }));
}

void add_outcomes(std::vector<text::TextColumn>& columns, const StudySummary& summary) {
  columns.push_back(by_point(summary, "stable", [](const measures::PointSummary& p) {
    return text::percentage(p.of(&trial::MoveOutcome::stable).trials, p.judged);
  }));
  if (any_undecided(summary)) {
    columns.push_back(by_point(summary, "undecided", [](const measures::PointSummary& p) {
      return text::percentage(p.outcomes.off_target, p.judged);
    }));
  }
  for (const NotStable& reason : not_stable) {
    if (!is_shown(summary, reason)) continue;
    columns.push_back(by_point(summary, reason.head, [&](const measures::PointSummary& p) {
      return text::percentage(reason.trials(p), p.judged);
    }));
  }
  add_rigs(columns, summary, goal::success(summary.question));
}

/// Only where points differ in it.
void add_trials(std::vector<text::TextColumn>& columns, const StudySummary& summary) {
  if (!trials_of_each(summary))
    columns.push_back(by_point(summary, "trials",
                               [](const measures::PointSummary& p) { return fmt::format("{}", p.trials); }));
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
    case layout::CellText::percent:
      return text::percentage(std::llround(value * text::to_double(point.moves)), point.moves);
    case layout::CellText::settling_time:
      return settling_text(point, value);
    case layout::CellText::proportion_of_trials:
      return text::percentage(std::llround(value), point.trials);
    case layout::CellText::proportion_of_moves:
      return text::percentage(std::llround(value), point.moves);
  }
  return text::short_number(value);
}

/// " [low, high]", with percent signs only in the cell before; nothing without bounds.
std::string bounds_text(const layout::SummaryColumn& column, const measures::MeasureStatistics& statistics) {
  if (!column.bounds) return "";
  const double low = measures::value_of(column.bounds->low, statistics);
  const double high = measures::value_of(column.bounds->high, statistics);
  if (std::isnan(low) || std::isnan(high)) return "";
  if (column.text == layout::CellText::percent) return fmt::format(" [{}]", text::percent_bounds(low, high));
  return fmt::format(" [{}, {}]", text::short_number(low), text::short_number(high));
}

void add_measure(std::vector<text::TextColumn>& columns, const StudySummary& summary,
                 const layout::Measure& measure) {
  for (const layout::SummaryColumn& column : measure.summary.columns) {
    columns.push_back(by_point(summary, parameters::text_on(summary.features.axis, column.head),
                               [&](const measures::PointSummary& point) {
                                 const measures::MeasureStatistics& of = point.of(measure);
                                 return cell_text(column.text, point,
                                                  measures::value_of(column.statistic, of)) +
                                        bounds_text(column, of);
                               }));
  }
}

void add_measures(std::vector<text::TextColumn>& columns, const StudySummary& summary) {
  for (const layout::Measure* measure : shown_measures(summary)) add_measure(columns, summary, *measure);
}

/// The meaning of the columns of the measures that `belongs` picks.
std::string legend_of(const StudySummary& summary, bool (*belongs)(const layout::Measure&)) {
  std::string legend;
  for (const layout::Measure* measure : shown_measures(summary)) {
    if (belongs(*measure)) legend += parameters::text_on(summary.features.axis, measure->summary.legend);
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
  for (const std::int64_t point : complete_points(summary)) {
    const theory::PointPrediction& prediction = summary.predictions[static_cast<std::size_t>(point)];
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

std::vector<text::TextColumn> zero_count_columns(const StudySummary& summary, std::int64_t chosen) {
  std::vector<text::TextColumn> columns = sweep_columns(summary, chosen);
  add_success(columns, summary);
  add_trials(columns, summary);
  add_measures(columns, summary);
  add_outcomes(columns, summary);
  if (has_predictions(summary)) add_predictions(columns, summary);
  if (const std::vector<std::string> observed = observations(summary); !observed.empty()) {
    text::TextColumn column{"observed", false, {}};
    for (const std::string& text : observed) column.cells.push_back(text::printable(text));
    columns.push_back(std::move(column));
  }
  return columns;
}

std::vector<text::TextColumn> question_columns(const StudySummary& summary, std::int64_t chosen) {
  if (!summary.question.claim()) return zero_count_columns(summary, chosen);
  std::vector<text::TextColumn> columns = sweep_columns(summary, chosen);
  add_goal(columns, summary);
  add_trials(columns, summary);
  for (const layout::Measure* measure : shown_measures(summary)) {
    if (measure->field.column.name == goal::settling_measure(summary.question))
      add_measure(columns, summary, *measure);
  }
  add_rigs(columns, summary, summary.question);
  return columns;
}

std::optional<std::int64_t> trials_of_each(const StudySummary& summary) {
  if (summary.points.empty()) return std::nullopt;
  const std::int64_t trials = summary.points.front().trials;
  const bool equal = std::ranges::all_of(
      summary.points, [&](const measures::PointSummary& point) { return point.trials == trials; });
  return equal ? std::optional(trials) : std::nullopt;
}

/// Rigs that have trials; of an unfinished run, at the point with most of them.
std::int64_t rigs_of(const StudySummary& summary) {
  std::int64_t rigs = 0;
  for (const measures::PointSummary& point : summary.points) rigs = std::max(rigs, point.rigs.n);
  return rigs;
}

std::string size_line(const StudySummary& summary) {
  const std::size_t points = summary.points.size();
  std::string line = fmt::format("{} point{}", points, points == 1 ? "" : "s");
  if (const std::optional<std::int64_t> trials = trials_of_each(summary))
    line += fmt::format(" × {} trials", *trials);
  if (summary.features.rigs) line += fmt::format(" on {} rigs", rigs_of(summary));
  return line;
}

std::string design_line(const StudySummary& summary) {
  const study::StudyFeatures& features = summary.features;
  if (features.dependent_trials) {
    return "The trials of a saltelli design are not independent: all bounds here are too narrow. They are "
           "for 'zerocount sensitivity'";
  }
  std::string line = fmt::format("design: {}", summary.design);
  if (features.rigs && !summary.points.empty()) {
    line += fmt::format(
        ", {} rigs: bounds are of all rigs that the manifest describes, and more trials on the same rigs "
        "narrow them only so far",
        rigs_of(summary));
  }
  if (summary.question.worlds > 0) {
    line += fmt::format(", {} worlds: rates over all trials are averages over the worlds{}",
                        summary.question.worlds,
                        summary.question.claim() ? "; those of the goal are of the worst world" : "");
  }
  if (features.spread_trials) {
    line += fmt::format(
        "{} bounds are conservative: made for trials by chance, which vary more than those of this design",
        features.rigs || summary.question.worlds > 0 ? ";" : ":");
  }
  return line;
}

std::string loop_legend(const StudySummary& summary) {
  const study::StudyFeatures& features = summary.features;
  std::string legend;
  if (summary.points.size() > 1) legend += "*: the chosen point, of which the last lines speak\n";
  if (summary.question.claim()) {
    legend += fmt::format(
        "in goal: {}{}; one-sided {} bounds of each point alone, in %\n",
        goal::goal_sentence(*summary.question.claim()),
        summary.question.worlds > 0 ? ", in the worst world; bounds of the worst of all worlds" : "",
        text::percent(summary.question.claim()->confidence));
  }
  legend += "zero-count: proportion of trials whose moves all ended at zero error; bounds of it after " +
            std::string(features.rigs ? "Korn and Graubard" : "Clopper and Pearson") +
            ", in %\n"
            "stable: proportion of trials whose moves all arrived and stayed within one count\n" +
            legend_of(summary, [](const layout::Measure& m) { return m.summary.use == nullptr; });
  if (has_several_trials_of_rigs(summary)) {
    for (const goal::QuestionWords* words :
         {&words_of(goal::success(summary.question)), &words_of(summary.question)}) {
      const std::string line = fmt::format("{}: {}\n", words->rig_head, words->rig_meaning);
      if (!legend.ends_with(line)) legend += line;
    }
  }
  if (any_undecided(summary)) {
    legend +=
        "undecided: proportion of trials whose worst move ended off target, stalled or still on its way: "
        "neither stable nor shown unstable\n";
  }
  for (const NotStable& reason : not_stable) {
    if (is_shown(summary, reason)) legend += reason.legend;
  }
  legend += legend_of(summary, layout::is_quality);
  legend += legend_of(
      summary, [](const layout::Measure& m) { return m.summary.use != nullptr && !layout::is_quality(m); });
  if (has_predictions(summary)) {
    legend +=
        "(6), (7): proportion of trials in which the paper's criterion (6) holds, which promises stability "
        "before sliding, and in which its criterion (7) is exceeded, which rules it out; by the friction "
        "where the trial starts\n";
  }
  return legend;
}

}  // namespace zerocount::summary
