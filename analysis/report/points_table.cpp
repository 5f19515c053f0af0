#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "analysis/document/markup.hpp"
#include "analysis/measures/point_columns.hpp"
#include "analysis/report/html.hpp"
#include "analysis/report/report_sections.hpp"
#include "analysis/statistics/tolerance.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::report {
namespace {

constexpr std::size_t max_points = 400;

/// Empty if too few moves arrived for any bound.
std::string settling_bounds(const measures::PointSummary& point, const statistics::Quantile& quantile) {
  if (std::isnan(quantile.low) && std::isnan(quantile.high)) return "–";
  const std::string low = std::isnan(quantile.low) ? "0" : text::short_number(quantile.low);
  return fmt::format("{} … {}", low, summary::settling_text(point, quantile.high));
}

using Point = const measures::PointSummary&;
using Theory = const theory::PointPrediction&;
using Bounds = const statistics::ConfidenceInterval&;

/// A column of the table of points, with the function that makes its cells.
struct PointCell {
  const char* head;
  const char* unit;
  std::string (*text)(Point point, Theory prediction);
  std::string (*below)(Point point, Bounds success){nullptr};
  bool needs_independence{false};  ///< valid only for independent trials
  bool needs_rigs{false};
};

/// The table of outcomes.
constexpr PointCell outcome_cells[] = {
    {"trials", "", [](Point point, Theory) { return std::to_string(point.trials); }},
    {"zero-count", "95 % bounds",
     [](Point point, Theory) { return text::percentage(point.outcomes.zero_count, point.trials); },
     [](Point, Bounds rate) { return text::percent_bounds(rate.low, rate.high, 1, " … "); }},
    {"failures at most", "at 95 %",
     [](Point point, Theory) { return text::percent_at_most(point.claim.failure_at_most); }, nullptr, true},
    {"rigs without failure", "95 % bounds",
     [](Point point, Theory) {
       return fmt::format("{:.0f} of {}", point.rigs.without_failure * static_cast<double>(point.rigs.n),
                          point.rigs.n);
     },
     [](Point point, Bounds) {
       return text::percent_bounds(point.rigs.without_failure_bounds.low,
                                   point.rigs.without_failure_bounds.high, 1, " … ");
     },
     false, true},
    {"sd between rigs", "", [](Point point, Theory) { return text::short_number(point.rigs.success_sd); },
     nullptr, false, true},
    {"worst 5 % of rigs", "", [](Point point, Theory) { return proportion_text(point.rigs.worst_5_percent); },
     nullptr, false, true},
    {"one count", "", [](Point point, Theory) { return std::to_string(point.outcomes.one_count); }},
    {"undecided", "", [](Point point, Theory) { return std::to_string(point.outcomes.off_target); }},
    {"oscil\u00adlating", "", [](Point point, Theory) { return std::to_string(point.outcomes.oscillating); }},
    {"lost", "", [](Point point, Theory) { return std::to_string(point.outcomes.nonfinite); }},
    {"stable", "",
     [](Point point, Theory) {
       return text::percentage(point.of(&trial::MoveOutcome::stable).trials, point.trials);
     }},
};

/// The table of times, jerks and criteria: with those of outcomes it would be wider than the page.
constexpr PointCell motion_cells[] = {
    {"arrival, median", "s",
     [](Point point, Theory) {
       return summary::settling_text(point, point.of(&trial::MoveOutcome::settling_time).median.value);
     },
     [](Point point, Bounds) {
       return settling_bounds(point, point.of(&trial::MoveOutcome::settling_time).median);
     }},
    {"arrival, 95 %", "s",
     [](Point point, Theory) {
       return summary::settling_text(point, point.of(&trial::MoveOutcome::settling_time).p95.value);
     },
     [](Point point, Bounds) {
       return settling_bounds(point, point.of(&trial::MoveOutcome::settling_time).p95);
     }},
    {"jerks per trial", "",
     [](Point point, Theory) { return text::short_number(point.of(&trial::MoveOutcome::jerk_count).mean); }},
    {"(6) holds", "",
     [](Point, Theory prediction) {
       return text::percentage(prediction.stable, theory::predicted_trials(prediction));
     }},
    {"(7) ex\u00adceeded", "",
     [](Point, Theory prediction) {
       return text::percentage(prediction.unstable, theory::predicted_trials(prediction));
     }},
};

HtmlColumn label_column(const ReportedStudy& reported, std::size_t rows) {
  HtmlColumn label{"point", "", true, {}};
  for (std::size_t i = 0; i < rows; ++i)
    label.cells.push_back(marked_label_of(reported, static_cast<std::int64_t>(i)));
  return label;
}

/// The 95 % quantile of the settling time of an error band, s.
HtmlColumn band_column(const ReportedStudy& reported, std::int64_t band, std::size_t rows) {
  HtmlColumn column{fmt::format("settled ±{}, 95 %", band), "s", false, {}};
  for (std::size_t i = 0; i < rows; ++i) {
    const measures::PointSummary& point = reported.summary.points[i];
    const statistics::Quantile p95 = measures::of_band(point, "band_settling_time", band).p95;
    column.cells.push_back(summary::settling_text(point, p95.value));
    column.below.push_back(settling_bounds(point, p95));
  }
  return column;
}

/// The goal at each point: the verdict, and the proportions with their one-sided bounds.
std::vector<HtmlColumn> goal_columns(const ReportedStudy& reported, std::size_t rows) {
  const summary::StudySummary& summary = reported.summary;
  const study::Goal& goal = *summary.question.claim();
  const std::vector<std::optional<goal::Verdict>> verdicts = summary::goal_verdicts(summary);
  const std::string bounds = text::percent(goal.confidence) + " bounds";
  const std::string where = summary.question.worlds > 0 ? " (worst world)" : "";
  std::vector<HtmlColumn> columns{
      label_column(reported, rows), {"goal", "", true, {}}, {"moves in goal" + where, bounds, false, {}}};
  if (goal.machines) columns.push_back({"machines in goal" + where, bounds, false, {}});
  const auto add = [](HtmlColumn& column, const goal::BoundedProportion& proportion) {
    column.cells.push_back(text::percent_near(proportion.value));
    column.below.push_back(text::percent_bounds(proportion.low, proportion.high, 1, " … "));
  };
  HtmlColumn rigs{"rigs without a miss", "", false, {}};
  HtmlColumn trials{"trials", "", false, {}};
  for (std::size_t i = 0; i < rows; ++i) {
    const goal::Verdict verdict = verdicts[i].value_or(goal::Verdict{});
    columns[1].cells.emplace_back(goal::text_of(verdict.status));
    add(columns[2], verdict.moves);
    if (goal.machines) add(columns[3], verdict.machines);
    const goal::RigsWithoutFailure without = rigs_without_failure(summary.question, summary.points[i]);
    rigs.cells.push_back(fmt::format("{} of {}", without.rigs, without.of));
    trials.cells.push_back(std::to_string(summary.points[i].trials));
  }
  columns.push_back(band_column(reported, goal.band, rows));
  if (summary.features.rigs) columns.push_back(std::move(rigs));
  columns.push_back(std::move(trials));
  return columns;
}

/// The 95 % quantile of the settling time of each error band.
std::vector<HtmlColumn> band_columns(const ReportedStudy& reported, std::size_t rows) {
  std::vector<HtmlColumn> columns;
  for (const std::int64_t band : reported.summary.features.bands.values())
    columns.push_back(band_column(reported, band, rows));
  return columns;
}

void append(std::vector<HtmlColumn>& columns, std::vector<HtmlColumn> more, std::size_t at) {
  columns.insert(columns.begin() + static_cast<std::ptrdiff_t>(at), std::make_move_iterator(more.begin()),
                 std::make_move_iterator(more.end()));
}

HtmlColumn observed_column(const summary::StudySummary& summary, std::size_t rows) {
  HtmlColumn observed{"observed on the rig", "", true, {}};
  for (std::size_t i = 0; i < rows; ++i)
    observed.cells.push_back(summary::observed_at(summary, static_cast<std::int64_t>(i)));
  for (const measures::SummarySection& section : summary.sections) {
    if (section.key != summary::observed_key) continue;
    for (std::size_t i = 0; i < rows; ++i)
      observed.below.push_back(section.json[i].is_null() ? ""
                                                         : section.json[i]["statement"].get<std::string>());
  }
  return observed;
}

HtmlColumn column_of(const PointCell& cell, const ReportedStudy& reported, std::size_t rows) {
  const summary::StudySummary& summary = reported.summary;
  HtmlColumn column{cell.head, cell.unit, false, {}};
  if (summary.features.dependent_trials && cell.below != nullptr)
    column.unit += (column.unit.empty() ? "" : "; ") + std::string("bounds too narrow");
  for (std::size_t i = 0; i < rows; ++i) {
    const theory::PointPrediction prediction =
        summary.predictions.empty() ? theory::PointPrediction{} : summary.predictions[i];
    column.cells.push_back(cell.text(summary.points[i], prediction));
    if (cell.below != nullptr)
      column.below.push_back(cell.below(summary.points[i], reported.success_bounds[i]));
  }
  return column;
}

std::vector<HtmlColumn> columns_of(std::span<const PointCell> cells, const ReportedStudy& reported,
                                   std::size_t rows) {
  const study::StudyFeatures& features = reported.summary.features;
  std::vector<HtmlColumn> columns{label_column(reported, rows)};
  for (const PointCell& cell : cells) {
    const bool valid = !(features.dependent_trials && cell.needs_independence);
    if (valid && (features.rigs || !cell.needs_rigs)) columns.push_back(column_of(cell, reported, rows));
  }
  return columns;
}

std::string goal_table(const ReportedStudy& reported, std::size_t rows) {
  const summary::StudySummary& summary = reported.summary;
  return html_table(goal_columns(reported, rows)) +
         fmt::format(
             "<p class=\"note\">Bounds are one-sided, of each point alone. Settled: the error stays "
             "within the goal's band from then to the end of the move. {}</p>\n",
             document::markup(summary::design_line(summary)));
}

std::string zero_count_tables(const ReportedStudy& reported, std::size_t rows) {
  const summary::StudySummary& summary = reported.summary;
  const bool dependent = summary.features.dependent_trials;
  constexpr std::size_t after_arrival = 3;  // label, median and 95 % quantile
  std::vector<HtmlColumn> outcomes = columns_of(outcome_cells, reported, rows);
  std::vector<HtmlColumn> motion = columns_of(motion_cells, reported, rows);
  append(motion, band_columns(reported, rows), after_arrival);
  if (!summary.observed.empty()) motion.push_back(observed_column(summary, rows));
  return html_table(outcomes) +
         fmt::format(
             "<p class=\"note\">zero-count: proportion of trials all of whose moves ended at zero error, "
             "with {}.{} One count, undecided, oscillating, lost: trials by their worst move. Undecided: a "
             "move ended off target (stalled or still moving); it is neither stable nor shown unstable. {}"
             "{}</p>\n",
             reported.bounds_name,
             dependent ? "" : " Failures at most: one-sided upper bound of the failure probability.",
             summary.features.rigs
                 ? "Sd between rigs: standard deviation of the success probability. Worst 5 % of rigs: mean "
                   "observed success rate of the rigs with the lowest rates. "
                 : "",
             dependent ? document::markup(fmt::format("{} {}", dependence_sentence, too_narrow_sentence))
                       : document::markup(summary::design_line(summary))) +
         html_table(motion) +
         "<p class=\"note\">Arrival: the error is first 0 for the whole dwell. Settled ±b: the error stays "
         "within b counts from then to the end of the move. Quantiles are those of all moves, with "
         "order-statistic bounds; moves that never arrived, or end outside, are later than all others. "
         "(6), (7): trials in which the paper's "
         "criteria hold and are exceeded.</p>\n";
}

/// "Repeatability" for "repeatability".
std::string title_of(std::string key) {
  if (!key.empty() && key.front() >= 'a' && key.front() <= 'z')
    key.front() = static_cast<char>(key.front() - 'a' + 'A');
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

std::string level_table_html(const summary::StudySummary& summary, std::size_t rows) {
  std::vector<HtmlColumn> columns;
  for (text::TextColumn& column : summary::level_table(summary).columns) {
    column.cells.resize(std::min(column.cells.size(), rows));
    columns.push_back({column.head, "", !column.numeric, std::move(column.cells)});
  }
  return html_table(columns) + fmt::format("<p class=\"note lines\">{}</p>\n",
                                           document::markup(summary::level_legend(summary.features.axis)));
}

/// Rows of the table of points, or levels.
std::size_t all_rows(const ReportedStudy& reported) {
  const std::size_t points = reported.summary.points.size();
  return reported.study.open_loop ? points * static_cast<std::size_t>(reported.file.moves()) : points;
}

/// The sections of the summary about the question of the study, or the others.
std::string sections_html(const summary::StudySummary& summary, bool of_question) {
  std::string html;
  for (const measures::SummarySection& section : summary.sections) {
    const std::string text = measures::text_of(section, summary::points_shown(summary, {}));
    if (!text.empty() && is_of_question(summary, section) == of_question)
      html += html_preformatted(title_of(section.key), text, section.open);
  }
  return html;
}

}  // namespace

std::string points_html(const ReportedStudy& reported) {
  const summary::StudySummary& summary = reported.summary;
  const std::size_t all = all_rows(reported);
  const std::size_t rows = std::min(all, max_points);
  const bool claim = summary.question.claim().has_value();
  std::string html = reported.study.open_loop ? level_table_html(summary, rows)
                     : claim                  ? goal_table(reported, rows)
                                              : zero_count_tables(reported, rows);
  if (rows < all) {
    html += fmt::format(
        "<p class=\"note\">The first {} of {} rows; all are printed by <code>zerocount summary</code>.</p>\n",
        rows, all);
  }
  return html + sections_html(summary, true);
}

std::string zero_count_tables_html(const ReportedStudy& reported) {
  return zero_count_tables(reported, std::min(all_rows(reported), max_points)) +
         sections_html(reported.summary, false);
}

}  // namespace zerocount::report
