#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "analysis/goal/question.hpp"
#include "analysis/measures/measure_statistics.hpp"
#include "analysis/summary_answer/parts.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Bounded;
using document::Notation;
using Point = const PointReading&;
using Statistics = const measures::PointSummary&;
using summary::StudySummary;

/// Whether some point of the table `is` so.
template <typename Is>
bool any_point(const StudySummary& summary, Is is) {
  return std::ranges::any_of(summary::complete_points(summary), [&](std::int64_t point) {
    return is(summary.points[static_cast<std::size_t>(point)]);
  });
}

bool any_undecided(const StudySummary& summary) {
  return any_point(summary, [](Statistics point) { return point.outcomes.off_target > 0; });
}

/// What keeps a trial from being stable, by its worst move. With the stable trials and the undecided ones,
/// which ended off target, these are all.
struct NotStable {
  const char* head;
  std::int64_t (*trials)(Statistics point);
  const char* legend;
};

constexpr std::array<NotStable, 2> not_stable{
    {{"in jerks",
      [](Statistics p) {
        return p.outcomes.zero_count + p.outcomes.one_count - p.of(&trial::MoveOutcome::stable).trials;
      },
      "in jerks: proportion of trials that ended within one count, but not stable: a move was still creeping "
      "in "
      "jerks, which kept the error from being zero for a dwell or carried it beyond one count after that, or "
      "it hunts by one count; a longer hold tells which"},
     {"oscillates", [](Statistics p) { return p.outcomes.oscillating + p.outcomes.nonfinite; },
      "oscillates: proportion of trials with a move whose error still swung by more than one count at its "
      "end, "
      "or that was lost"}}};

/// Whether these are many enough at some point to have a column.
bool is_shown(const StudySummary& summary, const NotStable& reason) {
  constexpr double min_proportion = 0.02;
  return any_point(summary, [&](Statistics point) {
    return static_cast<double>(reason.trials(point)) > min_proportion * static_cast<double>(point.judged);
  });
}

/// With one trial per rig, rigs without a failure are the trials without one.
bool has_several_trials_of_rigs(const StudySummary& summary) {
  return any_point(summary, [](Statistics point) { return point.rigs.n > 0 && point.trials > point.rigs.n; });
}

/// A column of text that is made of the statistics of a point. @param table its title; empty: that of the
/// points
template <typename Cell>
void add_cells(PointDescription& point, const std::string& table, const std::string& heading,
               const std::string& meaning, Cell cell) {
  point.value({.heading = heading, .meaning = meaning, .numeric = true, .own_table = table},
              [cell](Point p) { return cell(p.statistics()); });
}

void add_success(PointDescription& point, const StudySummary& summary) {
  point.value(
      {.heading = fmt::format("zero-count [{}]", bounds_head(summary)),
       .meaning = "zero-count: proportion of trials whose moves all ended at zero error; bounds of it "
                  "after " +
                  std::string(summary.features.rigs ? "Korn and Graubard" : "Clopper and Pearson") + ", in %",
       .unit = "1",
       .notation = Notation::percent,
       .own_table = zero_count_table(summary)},
      [](Point p) {
        const measures::RateWithBounds& rate = p.statistics().success_rate();
        return Bounded{rate.value, rate.clopper_pearson.low, rate.clopper_pearson.high};
      });
}

/// Rigs without a failure by the question.
void add_rigs(PointDescription& point, const std::string& table, const StudySummary& summary,
              const goal::Question& question) {
  if (!has_several_trials_of_rigs(summary)) return;
  const goal::QuestionWords& words = goal::words_of(question);
  add_cells(point, table, std::string(words.rig_head),
            fmt::format("{}: {}", words.rig_head, words.rig_meaning), [question](Statistics p) {
              const goal::RigsWithoutFailure rigs = goal::rigs_without_failure(question, p);
              return text::percentage(rigs.rigs, rigs.of);
            });
}

void add_outcomes(PointDescription& point, const StudySummary& summary) {
  const std::string table = zero_count_table(summary);
  add_cells(
      point, table, "stable",
      "stable: proportion of trials whose moves all arrived and stayed within one count",
      [](Statistics p) { return text::percentage(p.of(&trial::MoveOutcome::stable).trials, p.judged); });
  if (any_undecided(summary)) {
    add_cells(point, table, "undecided",
              "undecided: proportion of trials whose worst move ended off target, stalled or still on its "
              "way: neither stable nor shown unstable",
              [](Statistics p) { return text::percentage(p.outcomes.off_target, p.judged); });
  }
  for (const NotStable& reason : not_stable) {
    if (!is_shown(summary, reason)) continue;
    add_cells(point, table, reason.head, reason.legend,
              [trials = reason.trials](Statistics p) { return text::percentage(trials(p), p.judged); });
  }
  add_rigs(point, table, summary, goal::success(summary.question));
}

/// Only where points differ in it.
void add_trials(PointDescription& point, const StudySummary& summary) {
  if (trials_of_each(summary)) return;
  point.value({.heading = "trials"}, [](Point p) { return p.statistics().trials; });
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

std::string cell_text(layout::CellText text, Statistics point, double value) {
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

/// The lines of a legend, joined.
std::string legend_line(parameters::AxisKind axis, const layout::Measure& measure) {
  std::string legend = parameters::text_on(axis, measure.summary.legend);
  while (legend.ends_with('\n')) legend.pop_back();
  return legend;
}

void add_measure(PointDescription& point, const std::string& table, const StudySummary& summary,
                 const layout::Measure& measure) {
  const parameters::AxisKind axis = summary.features.axis;
  std::string legend = legend_line(axis, measure);
  for (const layout::SummaryColumn& column : measure.summary.columns) {
    add_cells(point, table, parameters::text_on(axis, column.head), std::exchange(legend, ""),
              [&measure, column](Statistics p) {
                const measures::MeasureStatistics& of = p.of(measure);
                return cell_text(column.text, p, measures::value_of(column.statistic, of)) +
                       bounds_text(column, of);
              });
  }
}

/// Whether the settling times of the goal are those of a measure of all moves.
bool asks_all_moves_alike(const goal::Question& question) {
  return !has_several(question) && question.conditions.empty() && question.counted().on.empty();
}

}  // namespace

std::string settling_text(Statistics point, double time) {
  if (!std::isnan(time) || point.of(&trial::MoveOutcome::settling_time).moves == 0)
    return text::short_number(time);
  return std::isnan(point.hold) ? "> hold" : fmt::format("> {} s", text::short_number(point.hold));
}

void add_question_columns(PointDescription& point, const StudySummary& summary) {
  const std::string zero_counts = zero_count_table(summary);
  if (summary.question.claim()) {
    add_trials(point, summary);
    if (asks_all_moves_alike(summary.question)) {
      for (const layout::Measure* measure : shown_measures(summary)) {
        if (measure->field.column.name == goal::settling_measure(summary.question))
          add_measure(point, "", summary, *measure);
      }
    } else {
      add_cells(point, "", "95 % within",
                "95 % within: 95 % quantile of the settling time of the moves that a goal asks, s, of the "
                "goal and condition that leave the least of the time allowed",
                [question = summary.question](Statistics p) {
                  return settling_text(p, settling_of(question, p).p95.value);
                });
    }
    add_rigs(point, "", summary, summary.question);
  }
  add_success(point, summary);
  if (!summary.question.claim()) add_trials(point, summary);
  for (const layout::Measure* measure : shown_measures(summary))
    add_measure(point, zero_counts, summary, *measure);
  add_outcomes(point, summary);
}

}  // namespace zerocount::summary_answer
