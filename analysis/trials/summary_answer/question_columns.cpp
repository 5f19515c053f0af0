#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/measure_statistics.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/summary_answer/parts.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Bounded;
using document::Notation;
using Point = const DescribedPoint&;
using Statistics = const measures::PointSummary&;
using summary::StudySummary;

/// Whether the function `is` returns true for the statistics of any design point of the table.
template <typename Is>
bool any_point(const StudySummary& summary, Is is) {
  return std::ranges::any_of(summary::points_with_all_statistics(summary), [&](std::int64_t point) {
    return is(summary.points[static_cast<std::size_t>(point)]);
  });
}

bool any_undecided(const StudySummary& summary) {
  return any_point(summary, [](Statistics point) { return point.outcomes.off_target > 0; });
}

/// An outcome of a trial (that of its worst move) that is not stable; stable means that the error stays
/// within one count after arrival. Every trial is either stable, undecided (ended off target), or has one of
/// these outcomes.
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

/// Whether trials with this outcome are frequent enough (above 2 %) at some design point for a column of
/// their own.
bool is_shown(const StudySummary& summary, const NotStable& reason) {
  constexpr double min_proportion = 0.02;
  return any_point(summary, [&](Statistics point) {
    return static_cast<double>(reason.trials(point)) > min_proportion * static_cast<double>(point.judged);
  });
}

/// Whether machines have several trials at some design point. With one trial per machine, a column for
/// machines without a failure would repeat that of trials.
bool has_several_trials_of_machines(const StudySummary& summary) {
  return any_point(summary,
                   [](Statistics point) { return point.machines.n > 0 && point.trials > point.machines.n; });
}

/// Adds a column of text, made from the statistics of each design point.
/// @param cell returns the text
/// @param table title of the table; empty: the table of points
template <typename Cell>
void add_text_column(PointDescription& point, const std::string& table, const std::string& heading,
                     const std::string& meaning, Cell cell) {
  point.value({.heading = heading, .meaning = meaning, .numeric = true, .own_table = table},
              [cell](Point p) { return cell(p.statistics()); });
}

void add_success(PointDescription& point, const StudySummary& summary) {
  point.value(
      {.heading = fmt::format("zero-count [{}]", bounds_head(summary)),
       .meaning = fmt::format(
           "zero-count: proportion of trials whose moves all ended at zero error{}; bounds of it after {}, in %",
           summary.question.of_mass, summary.features.machines ? "Korn and Graubard" : "Clopper and Pearson"),
       .unit = "1",
       .notation = Notation::percent,
       .own_table = zero_count_table(summary)},
      [](Point p) {
        const measures::RateWithBounds& rate = p.statistics().success_rate();
        return Bounded{rate.value, rate.clopper_pearson.low, rate.clopper_pearson.high};
      });
}

/// Percentage of machines without a failed trial, as text; if the study has a goal, of machines whose moves
/// all meet the worst claim (goal and setting).
std::string faultless_machines(Point p, const goal::Question& question) {
  if (question.goal() && p.verdict)
    return text::percentage(p.verdict->machines_without_miss, p.statistics().machines.n);
  const goal::MachinesWithoutFailure machines = goal::machines_without_failure(question, p.statistics());
  return text::percentage(machines.machines, machines.of);
}

void add_machines(PointDescription& point, const std::string& table, const StudySummary& summary,
                  const goal::Question& question) {
  if (!has_several_trials_of_machines(summary)) return;
  const std::string heading = question.goal() ? "machines w/o miss" : "machines w/o failure";
  const std::string meaning =
      question.goal()
          ? "proportion of machines all of whose moves meet the goal (the worst of several, under the worst "
            "condition)"
          : fmt::format("proportion of machines all of whose trials ended at zero error{}", question.of_mass);
  point.value({.heading = heading,
               .meaning = fmt::format("{}: {}", heading, meaning),
               .numeric = true,
               .own_table = table},
              [question](Point p) { return faultless_machines(p, question); });
}

void add_outcomes(PointDescription& point, const StudySummary& summary) {
  const std::string table = zero_count_table(summary);
  add_text_column(
      point, table, "stable",
      "stable: proportion of trials whose moves all arrived and stayed within one count",
      [](Statistics p) { return text::percentage(p.of(&trial::MoveOutcome::stable).trials, p.judged); });
  if (any_undecided(summary)) {
    add_text_column(
        point, table, "undecided",
        "undecided: proportion of trials whose worst move ended off target, stalled or still on its way: neither stable nor shown unstable",
        [](Statistics p) { return text::percentage(p.outcomes.off_target, p.judged); });
  }
  for (const NotStable& reason : not_stable) {
    if (!is_shown(summary, reason)) continue;
    add_text_column(point, table, reason.head, reason.legend,
                    [trials = reason.trials](Statistics p) { return text::percentage(trials(p), p.judged); });
  }
  add_machines(point, table, summary, goal::success(summary.question));
}

/// Adds a column with the number of trials, if design points differ in it.
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

/// Bounds of a statistic as text for a table cell: " [low, high]". Percent signs are left out, because the
/// cell's value has one. Empty without bounds.
std::string bounds_text(const layout::SummaryColumn& column, const measures::MeasureStatistics& statistics) {
  if (!column.bounds) return "";
  const double low = measures::value_of(column.bounds->low, statistics);
  const double high = measures::value_of(column.bounds->high, statistics);
  if (std::isnan(low) || std::isnan(high)) return "";
  if (column.text == layout::CellText::percent) return fmt::format(" [{}]", text::percent_bounds(low, high));
  return fmt::format(" [{}, {}]", text::short_number(low), text::short_number(high));
}

/// The explanation of a measure's column as one line. On an axis with two masses, "the rotor" is replaced by
/// the mass whose encoder closes the loop.
std::string legend_line(const StudySummary& summary, const layout::Measure& measure) {
  std::string legend = parameters::text_on(summary.features.axis, measure.summary.legend);
  std::string_view mass = summary.question.of_mass;
  if (constexpr std::string_view of = " of "; mass.starts_with(of))
    boost::algorithm::replace_all(legend, "the rotor", mass.substr(of.size()));
  while (legend.ends_with('\n')) legend.pop_back();
  return legend;
}

void add_measure(PointDescription& point, const std::string& table, const StudySummary& summary,
                 const layout::Measure& measure) {
  const parameters::AxisKind axis = summary.features.axis;
  std::string legend = legend_line(summary, measure);
  for (const layout::SummaryColumn& column : measure.summary.columns) {
    add_text_column(point, table, parameters::text_on(axis, column.head), std::exchange(legend, ""),
                    [&measure, column](Statistics p) {
                      const measures::MeasureStatistics& of = p.of(measure);
                      return cell_text(column.text, p, measures::value_of(column.statistic, of)) +
                             bounds_text(column, of);
                    });
  }
}

/// Whether the goal's settling times are simply those of a measure over all moves, so that the measure's
/// statistics serve for the goal.
bool asks_all_moves_alike(const goal::Question& question) {
  return !has_several(question) && question.settings.empty() && question.criterion().on.empty();
}

}  // namespace

std::string settling_text(Statistics point, double time) {
  if (!std::isnan(time) || point.of(&trial::MoveOutcome::arrival_time).moves == 0)
    return text::short_number(time);
  return std::isnan(point.hold) ? "> hold" : fmt::format("> {} s", text::short_number(point.hold));
}

void add_question_columns(PointDescription& point, const StudySummary& summary) {
  const std::string zero_counts = zero_count_table(summary);
  if (summary.question.goal()) {
    add_trials(point, summary);
    if (asks_all_moves_alike(summary.question)) {
      for (const layout::Measure* measure : shown_measures(summary)) {
        if (measure->field.column.name == goal::settling_measure(summary.question))
          add_measure(point, "", summary, *measure);
      }
    } else {
      add_text_column(
          point, "", "95 % within",
          "95 % within: 95 % quantile of the settling time of the moves that a goal asks, s, of the worst goal and condition, which the rate is of",
          [question = summary.question](Statistics p) {
            return settling_text(p, settling_of(question, p).p95.value);
          });
    }
    add_machines(point, "", summary, summary.question);
  }
  add_success(point, summary);
  if (!summary.question.goal()) add_trials(point, summary);
  for (const layout::Measure* measure : shown_measures(summary))
    add_measure(point, zero_counts, summary, *measure);
  add_outcomes(point, summary);
}

}  // namespace zerocount::summary_answer
