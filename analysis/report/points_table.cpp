#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

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
using Theory = const measures::TheoryPrediction&;
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

constexpr PointCell point_cells[] = {
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
    {"settling, median", "s",
     [](Point point, Theory) {
       return summary::settling_text(point, point.of(&trial::MoveOutcome::settling_time).median.value);
     },
     [](Point point, Bounds) {
       return settling_bounds(point, point.of(&trial::MoveOutcome::settling_time).median);
     }},
    {"settling, 95 %", "s",
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
       return text::percentage(prediction.stable, measures::predicted_trials(prediction));
     }},
    {"(7) ex\u00adceeded", "",
     [](Point, Theory prediction) {
       return text::percentage(prediction.unstable, measures::predicted_trials(prediction));
     }},
};

std::string loop_table(const ReportedStudy& reported, std::size_t rows) {
  const summary::StudySummary& summary = reported.summary;
  HtmlColumn label{"point", "", true, {}};
  HtmlColumn observed{"observed on the rig", "", true, {}};
  for (std::size_t i = 0; i < rows; ++i) {
    label.cells.push_back(summary.labels[i]);
    observed.cells.push_back(summary::observed_at(summary, static_cast<std::int64_t>(i)));
  }
  for (const measures::SummarySection& section : summary.sections) {
    if (section.key != summary::observed_key) continue;
    for (std::size_t i = 0; i < rows; ++i)
      observed.below.push_back(section.json[i].is_null() ? ""
                                                         : section.json[i]["statement"].get<std::string>());
  }
  const bool dependent = summary.features.dependent_trials;
  std::vector<HtmlColumn> columns{label};
  for (const PointCell& cell : point_cells) {
    if (dependent && cell.needs_independence) continue;
    if (cell.needs_rigs && !summary.features.rigs) continue;
    HtmlColumn column{cell.head, cell.unit, false, {}};
    if (dependent && cell.below != nullptr)
      column.unit += (column.unit.empty() ? "" : "; ") + std::string("bounds too narrow");
    for (std::size_t i = 0; i < rows; ++i) {
      const measures::TheoryPrediction prediction =
          summary.predictions.empty() ? measures::TheoryPrediction{} : summary.predictions[i];
      column.cells.push_back(cell.text(summary.points[i], prediction));
      if (cell.below != nullptr)
        column.below.push_back(cell.below(summary.points[i], reported.success_bounds[i]));
    }
    columns.push_back(std::move(column));
  }
  if (!summary.observed.empty()) columns.push_back(observed);
  return html_table(columns) +
         fmt::format(
             "<p class=\"note\">zero-count: proportion of trials all of whose moves ended at zero error, "
             "with {}.{} One count, undecided, oscillating, lost: trials by their worst move. Undecided: a "
             "move ended off target (stalled or still moving); it is neither stable nor shown unstable. "
             "Quantiles of settling times are those of all moves, with order-statistic bounds; moves that "
             "never arrived count as later than all others. {}{}</p>\n",
             reported.bounds_name,
             dependent ? "" : " Failures at most: one-sided upper bound of the failure probability.",
             summary.features.rigs
                 ? "Sd between rigs: standard deviation of the success probability. Worst 5 % of rigs: mean "
                   "observed success rate of the rigs with the lowest rates. "
                 : "",
             dependent ? html_text(fmt::format("{} {}", dependence_sentence, too_narrow_sentence))
                       : html_text(summary::design_line(summary)));
}

/// "Repeatability" for "repeatability".
std::string title_of(std::string key) {
  if (!key.empty() && key.front() >= 'a' && key.front() <= 'z')
    key.front() = static_cast<char>(key.front() - 'a' + 'A');
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

std::string level_table_html(const summary::StudySummary& summary, std::size_t rows) {
  std::vector<HtmlColumn> columns{{"point", "", true, {}}, {"level", "", false, {}}};
  const parameters::AxisKind axis = summary.features.axis;
  const std::vector<measures::LevelField> fields = measures::level_fields(summary.table());
  for (const measures::LevelField& field : fields)
    columns.push_back({parameters::text_on(axis, field.long_name),
                       field.unit == "1" ? "" : parameters::unit_on(axis, field.unit),
                       false,
                       {}});
  std::size_t written = 0;
  for (std::size_t point = 0; point < summary.points.size(); ++point) {
    for (std::size_t level = 0; level < summary.points[point].levels.size() && written < rows;
         ++level, ++written) {
      std::vector<std::string> cells{summary.labels[point], fmt::format("{}", level + 1)};
      for (const measures::LevelField& field : fields)
        cells.push_back(text::short_number(field.value(summary.points[point].levels[level])));
      add_row(columns, std::move(cells));
    }
  }
  return html_table(columns);
}

}  // namespace

std::string points_html(const ReportedStudy& reported) {
  const summary::StudySummary& summary = reported.summary;
  std::size_t all = summary.points.size();
  if (reported.study.open_loop) all *= static_cast<std::size_t>(reported.file.moves());
  const std::size_t rows = std::min(all, max_points);
  std::string html = reported.study.open_loop ? level_table_html(summary, rows) : loop_table(reported, rows);
  if (rows < all) {
    html += fmt::format(
        "<p class=\"note\">The first {} of {} rows; all are printed by <code>zerocount summary</code>.</p>\n",
        rows, all);
  }
  for (const measures::SummarySection& section : summary.sections) {
    if (section.text.empty()) continue;
    html += html_folded(title_of(section.key), section.text);
  }
  return html;
}

}  // namespace zerocount::report
