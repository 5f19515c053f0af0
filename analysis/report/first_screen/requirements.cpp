#include "analysis/report/first_screen/requirements.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/document/markup.hpp"
#include "analysis/report/first_screen/quantity.hpp"
#include "analysis/report/html.hpp"
#include "analysis/summary/move_behaviour.hpp"
#include "analysis/text/percent.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::report {
namespace {

using summary::CellOfPoint;
using summary::MoveBehaviour;

/// "true overshoot ≤ 1 µm".
std::string limit_text(const study::GoalLimit& limit, const study::Study& study) {
  std::string words = limit.measure;
  std::ranges::replace(words, '_', ' ');
  if (const std::size_t torque = words.find("torque"); torque != std::string::npos)
    words.replace(torque, 6, parameters::text_on(study.units.axis, "$torque"));
  std::string unit;
  for (const layout::Measure& measure : layout::measure_table(study.features)) {
    if (measure.field.column.name == limit.measure)
      unit = parameters::unit_on(study.units.axis, measure.field.column.unit);
  }
  return fmt::format("{} ≤ {}", words, quantity_text(limit.largest, unit));
}

/// A row: a goal under a condition, or moves that no goal asks.
struct RequirementRow {
  std::optional<CellOfPoint> claim{};
  std::optional<MoveBehaviour> moves{};
  std::string condition{};
};

/// A column of the table: its head, and a cell of a row.
struct RequirementColumn {
  std::string head;
  std::string (*cell)(const RequirementRow& row, const ReportedStudy& reported);
};

std::string bounded_text(std::int64_t hits, std::int64_t of, double low) {
  return fmt::format("{} of {}: ≥ {}", hits, of, text::percent_at_least(low));
}

std::string verdict_cell(const RequirementRow& row, const ReportedStudy& /*reported*/) {
  if (!row.claim) return "";
  const char* const style = row.claim->status == goal::Status::met      ? "good"
                            : row.claim->status == goal::Status::missed ? "bad"
                                                                        : "open";
  return fmt::format("<span class=\"{}\">{}</span>", style, goal::text_of(row.claim->status));
}

std::string moves_cell(const RequirementRow& row, const ReportedStudy& /*reported*/) {
  return row.claim ? bounded_text(row.claim->met, row.claim->moves, row.claim->rate.low) : "";
}

std::string machines_cell(const RequirementRow& row, const ReportedStudy& /*reported*/) {
  if (!row.claim || !row.claim->machines) return "";
  return fmt::format("{}: ≥ {}", text::percent_near(row.claim->machines->value),
                     text::percent_at_least(row.claim->machines->low));
}

std::string time_cell(const RequirementRow& row, const ReportedStudy& /*reported*/) {
  if (!row.claim) return "";
  return row.claim->settling_time_p95 ? quantity_text(*row.claim->settling_time_p95, "s")
                                      : std::string("not in the hold");
}

std::string overshoot_cell(const RequirementRow& row, const ReportedStudy& reported) {
  if (!row.moves || std::isnan(row.moves->overshoot_length.p95)) return "";
  if (row.moves->overshoot_length.p95 == 0.0) return "none";
  const std::string length =
      quantity_text(row.moves->overshoot_length.p95, parameters::unit_on(reported.study.units.axis, "rad"));
  const double of_step = row.moves->overshoot_of_step.p95;
  return length + (std::isnan(of_step) ? "" : fmt::format(", {:.3g} % of the step", 100.0 * of_step));
}

std::string peak_cell(const RequirementRow& row, const ReportedStudy& reported) {
  if (!row.moves || std::isnan(row.moves->peak_torque.max)) return "";
  return fmt::format(
      "{}, {:.3g} % of the range",
      quantity_text(row.moves->peak_torque.max, parameters::unit_on(reported.study.units.axis, "N m")),
      100.0 * row.moves->peak_of_range.max);
}

std::string saturated_cell(const RequirementRow& row, const ReportedStudy& /*reported*/) {
  return row.moves ? text::percent_near(row.moves->saturated) : "";
}

std::string condition_cell(const RequirementRow& row, const ReportedStudy& /*reported*/) {
  return document::markup(row.condition);
}

std::vector<RequirementColumn> columns_of(const ReportedStudy& reported) {
  std::vector<RequirementColumn> columns;
  const bool has_claim = question_of(reported).claim().has_value();
  if (!reported.study.conditions.empty()) columns.push_back({"condition", condition_cell});
  if (has_claim) {
    columns.push_back({"verdict", verdict_cell});
    columns.push_back({"moves in the goal", moves_cell});
    if (std::ranges::any_of(reported.study.goals,
                            [](const study::Goal& goal) { return goal.machines.has_value(); }))
      columns.push_back({"machines in the goal", machines_cell});
    columns.push_back({"95 % settle within", time_cell});
  }
  columns.push_back({"overshoot (95 %)", overshoot_cell});
  columns.push_back({parameters::text_on(reported.study.units.axis, "peak $torque"), peak_cell});
  columns.push_back({"moves that saturate", saturated_cell});
  return columns;
}

std::string row_html(const RequirementRow& row, const std::vector<RequirementColumn>& columns,
                     const ReportedStudy& reported) {
  std::string html = "<tr>";
  for (const RequirementColumn& column : columns)
    html += fmt::format("<td class=\"text\" data-head=\"{}\">{}</td>", document::markup(column.head),
                        column.cell(row, reported));
  return html + "</tr>\n";
}

/// The rows of the goal with this number; the number of goals for moves that none asks.
std::vector<RequirementRow> rows_of_goal(std::size_t number, const ReportedStudy& reported,
                                         const std::vector<CellOfPoint>& claims,
                                         const std::vector<MoveBehaviour>& behaviour) {
  std::vector<RequirementRow> rows;
  const auto conditions = static_cast<std::size_t>(study::condition_count(reported.study));
  for (std::size_t i = 0; i < conditions; ++i) {
    RequirementRow row;
    if (!reported.study.conditions.empty()) row.condition = reported.study.conditions[i];
    if (const std::size_t at = number * conditions + i; at < claims.size()) row.claim = claims[at];
    for (const MoveBehaviour& one : behaviour) {
      if (one.number == number && one.condition.value_or("") == row.condition) row.moves = one;
    }
    if (row.claim || row.moves) rows.push_back(std::move(row));
  }
  return rows;
}

/// Head of the rows below it: their goal.
std::string title_of(std::size_t number, const ReportedStudy& reported) {
  const std::vector<study::Goal>& goals = reported.study.goals;
  if (number < goals.size()) {
    const std::string& name = goals[number].name;
    return (name.empty() ? "" : fmt::format("<b>{}</b> ", document::markup(name))) +
           document::prose_markup(requirement_text(goals[number], reported.study));
  }
  return goals.empty() ? "No goal is stated: what the moves do" : "Moves that no goal is about";
}

}  // namespace

std::string requirement_text(const study::Goal& goal, const study::Study& study) {
  std::string text =
      (goal.tolerance ? "±" + quantity_text(*goal.tolerance, parameters::unit_on(study.units.axis, "rad"))
                      : "±" + quantity_text(static_cast<double>(goal.band), "count")) +
      fmt::format(" for good after {}", quantity_text(goal.within, "s"));
  for (const study::GoalLimit& limit : goal.limits) text += "; " + limit_text(limit, study);
  const std::string moves = goal.on.empty() ? "the moves" : fmt::format("moves {}", fmt::join(goal.on, ", "));
  return text + fmt::format(
                    "; in {} of {}{}, with {} confidence", text::percent(goal.moves), moves,
                    goal.machines ? fmt::format(" of {} of the machines", text::percent(*goal.machines)) : "",
                    text::percent(goal.confidence));
}

std::string requirements_html(const ReportedStudy& reported,
                              const std::vector<summary::CellOfPoint>& claims) {
  if (reported.study.open_loop) return "";
  const std::int64_t point = reported.chosen.point;
  const std::vector<MoveBehaviour> behaviour = summary::behaviour_in(reported.file, reported.study, point);
  const std::vector<RequirementColumn> columns = columns_of(reported);
  std::string html = "<table class=\"requirements\"><thead><tr>";
  for (const RequirementColumn& column : columns)
    html += fmt::format("<th class=\"text\">{}</th>", document::markup(column.head));
  html += "</tr></thead><tbody>\n";
  for (std::size_t number = 0; number <= std::max<std::size_t>(reported.study.goals.size(), 1); ++number) {
    const std::vector<RequirementRow> rows = rows_of_goal(number, reported, claims, behaviour);
    if (rows.empty()) continue;
    html += fmt::format("<tr class=\"group\"><th class=\"text\" colspan=\"{}\">{}</th></tr>\n",
                        columns.size(), title_of(number, reported));
    for (const RequirementRow& row : rows) html += row_html(row, columns, reported);
  }
  return html + "</tbody></table>\n";
}

}  // namespace zerocount::report
