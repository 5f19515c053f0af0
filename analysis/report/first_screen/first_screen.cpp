#include "analysis/report/first_screen/first_screen.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/document/blocks.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/report/report_sections.hpp"
#include "analysis/trials/summary/move_behaviour.hpp"
#include "analysis/trials/theory/point_theory.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/rules/value_sources.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::report {
namespace {

using rules::ValueSource;
using summary::CellOfPoint;
using summary::MoveBehaviour;

/// The parameter as the manifest's section `tune` lists it, with the range to search; null if `tune` does not
/// change it.
const study::FreeParameter* free_parameter(const study::Study& study, std::string_view name) {
  if (!study.tuning) return nullptr;
  const auto found = std::ranges::find(study.tuning->free, name, &study::FreeParameter::name);
  return found == study.tuning->free.end() ? nullptr : &*found;
}

/// Whether the parameter is chosen by the designer, rather than a property of the axis: gains and function
/// blocks of the controller, and what tune may change.
bool is_chosen(const study::Study& study, std::size_t slot) {
  const std::string_view name = study.plan->table.rows[slot].name;
  if (free_parameter(study, name) != nullptr) return true;
  return name.starts_with("controller.") && name != parameter::controller::delay &&
         name != parameter::controller::jitter && name != parameter::controller::missed;
}

/// Note on a value that the designer chooses, HTML: "default", or the range in which `tune` searches for it.
std::string note_of(const study::Study& study, const rules::SourcedValue& value) {
  const study::FreeParameter* const free = free_parameter(study, study.plan->table.rows[value.slot].name);
  if (free != nullptr) return range_text(free->low, free->high, "");
  return value.source == rules::ValueSource::assumed ? "default" : "";
}

/// The last part of a dotted parameter path: "kp" for "controller.kp".
std::string short_name(std::string_view name) {
  constexpr std::string_view section = "controller.";
  return std::string(name.starts_with(section) ? name.substr(section.size()) : name);
}

/// A range of stability margins as text: "11.3 … 11.5 dB", without line breaks; "–" if no trial has this
/// margin.
std::string margin_text(const theory::Range& range, std::string_view unit) {
  if (range.empty()) return "–";
  const auto number = [](double value) { return fmt::format("{:.3g}", value); };
  const std::string low = number(range.low);
  const std::string high = number(range.high);
  return (low == high ? low : low + "\u00a0…\u00a0" + high) + std::string(unit);
}

/// HTML of all values at a design point that the designer chooses: those that the manifest gives and the
/// defaults in effect, with the range in which `tune` searches for them.
std::string gains_html(const study::Study& study, std::int64_t point) {
  const PointValues values(study, point);
  document::TableBlock table{
      "",
      {{"controller", "", false}, {"value", "", false}, {study.tuning ? "range of tune" : "", "", false}}};
  for (const rules::SourcedValue& one : rules::value_sources(*study.plan)) {
    const parameters::Parameter& parameter = study.plan->table.rows[one.slot];
    const bool is_word = one.source == rules::ValueSource::assumed && parameters::has_labels(parameter);
    if (is_chosen(study, one.slot) && !is_word)
      table.add_row({short_name(parameter.name), values.text(one.slot), note_of(study, one)});
  }
  return document::html(table);
}

/// HTML of the stability margins of the linear loops at a design point in each setting (condition at an age),
/// as the command `check` prints them; empty where no loop is linear.
std::string loops_html(const study::Study& study, std::int64_t point) {
  if (theory::has_no_linear_loop(study::study_trial(study, point, 0).parameters)) return "";
  const bool has_settings = !study.settings.empty();
  document::TableBlock table{"",
                             {{"loop", "", false},
                              {"gain margin", "", false},
                              {"phase margin", "", false},
                              {"crossover", "", false}}};
  if (has_settings) table.columns.insert(table.columns.begin(), {"condition", "", false});
  std::vector<theory::KnownRotor> rotors;
  for (std::int64_t setting = 0; setting < study.settings.total(); ++setting) {
    for (const theory::LoopRanges& loop : theory::examine(study, point, setting, rotors).loops) {
      const std::string verdict = theory::stability_text(loop);
      std::vector<std::string> cells{loop.name + (verdict == "stable" ? "" : ": " + verdict),
                                     margin_text(loop.gain, "\u00a0dB"), margin_text(loop.phase, "°"),
                                     margin_text(loop.phase_at, "\u00a0Hz")};
      if (has_settings) cells.insert(cells.begin(), study::label_of(study.settings, setting));
      table.add_row(std::move(cells));
    }
  }
  return document::html(table);
}

/// A parameter with its value as HTML: "plant.inertia 3.2 … 4.6 kg", and how often it is drawn if it is
/// random. The section ("plant.") is omitted if the preceding value has the same one.
/// @param section section of the preceding value; updated
std::string value_html(const PointValues& values, std::size_t slot, std::string& section) {
  std::string name(values.study().plan->table.rows[slot].name);
  const std::size_t key = name.rfind('.') + 1;
  const bool is_same = name.substr(0, key) == section;
  section = name.substr(0, key);
  const std::string drawn = values.draw_text(slot);
  return fmt::format("<span><b>{}</b> {}{}</span>", document::markup(is_same ? name.substr(key) : name),
                     document::markup(values.text(slot)), drawn.empty() ? "" : ", " + drawn);
}

/// HTML row with a source of assumptions and the values that come from it.
/// @param items values as HTML; if there are none, the row is empty
std::string source_html(const std::string& source, const std::vector<std::string>& items) {
  if (items.empty()) return "";
  std::string html = fmt::format("<tr><th>{}</th><td>", document::markup(source));
  for (const std::string& item : items) html += item + " ";
  return html + "</td></tr>\n";
}

std::vector<std::string> values_from(ValueSource source, const std::vector<rules::SourcedValue>& all,
                                     const PointValues& values) {
  std::vector<std::string> items;
  std::string section;
  for (const rules::SourcedValue& one : all) {
    if (one.source == source && !is_chosen(values.study(), one.slot))
      items.push_back(value_html(values, one.slot, section));
  }
  return items;
}

std::vector<std::string> absent(const study::Study& study, study::PremiseState state) {
  std::vector<std::string> items;
  for (const study::Premise& premise : study.premises) {
    if (premise.state == state)
      items.push_back(fmt::format("<span>{}</span>", document::markup(premise.assumption)));
  }
  return items;
}

/// Assumptions of the trials of a design point by their source: measured, from a table of samples, given in
/// the manifest, defaults; then the effects of a real axis that are stated to be absent, and those that are
/// assumed to be.
std::string assumptions_html(const study::Study& study, std::int64_t point) {
  const PointValues values(study, point);
  const std::vector<rules::SourcedValue> all = rules::value_sources(*study.plan);
  const std::string samples = study.samples ? "samples of " + study.samples->file : "";
  return "<table class=\"assumptions\"><tbody>\n" +
         source_html("measured", values_from(ValueSource::measured, all, values)) +
         source_html(samples, values_from(ValueSource::sampled, all, values)) +
         source_html("given in the manifest", values_from(ValueSource::given, all, values)) +
         source_html("assumed: defaults", values_from(ValueSource::assumed, all, values)) +
         source_html("stated as absent", absent(study, study::PremiseState::stated_none)) +
         source_html("assumed away", absent(study, study::PremiseState::assumed)) + "</tbody></table>\n";
}

/// A limit of a goal as text: "true overshoot ≤ 1 µm".
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
  return fmt::format("{} {} {}", words, text::sign_of(limit.limit.relation),
                     quantity_text(limit.limit.value, unit));
}

/// A row of the table of requirements: a goal in a setting (condition at an age), or the moves that no goal
/// judges.
struct RequirementRow {
  std::optional<CellOfPoint> claim{};
  std::optional<MoveBehaviour> moves{};
  std::string setting{};
};

std::string verdict_cell(const CellOfPoint& claim) {
  const char* const style = claim.status == goal::Status::met      ? "good"
                            : claim.status == goal::Status::missed ? "bad"
                                                                   : "open";
  return fmt::format("<span class=\"{}\">{}</span>", style, goal::text_of(claim.status));
}

std::string moves_cell(const CellOfPoint& claim) {
  return fmt::format("{} of {}: ≥ {}", claim.met, claim.moves, text::percent_at_least(claim.rate.low));
}

std::string machines_cell(const CellOfPoint& claim) {
  if (!claim.machines) return "";
  return fmt::format("{}: ≥ {}", text::percent_near(claim.machines->value),
                     text::percent_at_least(claim.machines->low));
}

std::string time_cell(const CellOfPoint& claim) {
  return claim.settling_time_p95 ? quantity_text(*claim.settling_time_p95, "s")
                                 : std::string("not in the hold");
}

std::string overshoot_cell(const MoveBehaviour& moves, std::string_view unit) {
  if (std::isnan(moves.overshoot_length.p95)) return "";
  if (moves.overshoot_length.p95 == 0.0) return "none";
  const double of_step = moves.overshoot_of_step.p95;
  return quantity_text(moves.overshoot_length.p95, unit) +
         (std::isnan(of_step) ? "" : fmt::format(", {:.3g} % of the step", 100.0 * of_step));
}

std::string peak_cell(const MoveBehaviour& moves, std::string_view unit) {
  if (std::isnan(moves.peak_torque.max)) return "";
  return fmt::format("{}, {:.3g} % of the range", quantity_text(moves.peak_torque.max, unit),
                     100.0 * moves.peak_of_range.max);
}

/// The head of a table column, and the content of one row in it, both HTML.
using Cell = std::pair<std::string, std::string>;

/// The cells of the columns that all rows of the requirements table have.
std::vector<Cell> cells_of(const RequirementRow& row, const ReportedStudy& reported) {
  const parameters::AxisKind axis = reported.study.units.axis;
  std::vector<Cell> cells;
  if (!reported.study.settings.empty()) cells.emplace_back("condition", document::markup(row.setting));
  const auto of_claim = [&](const char* head, auto cell) {
    cells.emplace_back(head, row.claim ? cell(*row.claim) : "");
  };
  const auto of_moves = [&](const std::string& head,
                            const std::function<std::string(const MoveBehaviour&)>& cell) {
    cells.emplace_back(head, row.moves ? cell(*row.moves) : "");
  };
  if (question_of(reported).goal()) {
    of_claim("verdict", verdict_cell);
    of_claim("moves in the goal", moves_cell);
    if (std::ranges::any_of(reported.study.goals,
                            [](const study::Goal& goal) { return goal.machines.has_value(); }))
      of_claim("machines in the goal", machines_cell);
    of_claim("95 % settle within", time_cell);
  }
  of_moves("overshoot (95 %)", [&](const MoveBehaviour& moves) {
    return overshoot_cell(moves, parameters::unit_on(axis, "rad"));
  });
  of_moves(parameters::text_on(axis, "peak $torque"),
           [&](const MoveBehaviour& moves) { return peak_cell(moves, parameters::unit_on(axis, "N m")); });
  of_moves("moves that saturate",
           [](const MoveBehaviour& moves) { return text::percent_near(moves.saturated); });
  return cells;
}

/// The table rows of the goal `number`, one for each setting; if `number` is the number of goals, the rows
/// for moves that no goal judges.
std::vector<RequirementRow> rows_of_goal(std::size_t number, const ReportedStudy& reported,
                                         const std::vector<CellOfPoint>& claims,
                                         const std::vector<MoveBehaviour>& behaviour) {
  std::vector<RequirementRow> rows;
  const auto settings = static_cast<std::size_t>(reported.study.settings.total());
  for (std::size_t i = 0; i < settings; ++i) {
    RequirementRow row;
    if (!reported.study.settings.empty()) row.setting = study::label_of(reported.study.settings, i);
    if (const std::size_t at = number * settings + i; at < claims.size()) row.claim = claims[at];
    for (const MoveBehaviour& one : behaviour) {
      if (one.number == number && one.setting.value_or("") == row.setting) row.moves = one;
    }
    if (row.claim || row.moves) rows.push_back(std::move(row));
  }
  return rows;
}

/// Title above the table rows of a goal: the requirement in words.
std::string title_of(std::size_t number, const ReportedStudy& reported) {
  const std::vector<study::Goal>& goals = reported.study.goals;
  if (number < goals.size()) {
    const std::string& name = goals[number].name;
    return (name.empty() ? "" : fmt::format("<b>{}</b> ", document::markup(name))) +
           document::prose_markup(requirement_text(goals[number], reported.study));
  }
  return goals.empty() ? "No goal is stated: what the moves do" : "Moves that no goal is about";
}

/// HTML of a part of the first screen with its heading; empty if it has no content.
std::string part_html(const char* head, const std::string& content) {
  return content.empty() ? "" : fmt::format("<div><h3>{}</h3>\n{}</div>\n", head, content);
}

std::string lines_html(const std::vector<std::string>& lines) {
  std::string html;
  for (const std::string& line : lines) html += fmt::format("<p>{}</p>\n", document::prose_markup(line));
  return html.empty() ? "" : "<div class=\"notes\">\n" + html + "</div>\n";
}

std::vector<summary::CellOfPoint> claims_of_chosen(const ReportedStudy& reported) {
  return summary::claims_of_point(reported.summary, reported.chosen.point,
                                  static_cast<std::size_t>(reported.chosen.chosen_from));
}

/// CSS class of the headline: "good" if all claims are met, "bad" if one is missed, otherwise empty.
std::string_view style_of(const std::vector<summary::CellOfPoint>& claims) {
  const auto has = [&](goal::Status status) {
    return std::ranges::find(claims, status, &summary::CellOfPoint::status) != claims.end();
  };
  if (has(goal::Status::missed)) return "bad";
  return has(goal::Status::met) && !has(goal::Status::undecided) ? "good" : "";
}

}  // namespace

std::string requirement_text(const study::Goal& goal, const study::Study& study) {
  std::string text =
      (goal.tolerance ? "±" + quantity_text(*goal.tolerance, parameters::unit_on(study.units.axis, "rad"))
                      : "±" + quantity_text(static_cast<double>(goal.band), "count")) +
      goal::of_mass(goal) + " for good " +
      goal::after_text(goal.within, quantity_text(goal.within.time, "s"));
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
  std::string html = "<table class=\"requirements\"><thead><tr>";
  const std::vector<Cell> heads = cells_of({}, reported);
  for (const auto& [head, none] : heads)
    html += fmt::format("<th class=\"text\">{}</th>", document::markup(head));
  html += "</tr></thead><tbody>\n";
  for (std::size_t number = 0; number <= std::max<std::size_t>(reported.study.goals.size(), 1); ++number) {
    const std::vector<RequirementRow> rows = rows_of_goal(number, reported, claims, behaviour);
    if (rows.empty()) continue;
    html += fmt::format("<tr class=\"group\"><th class=\"text\" colspan=\"{}\">{}</th></tr>\n", heads.size(),
                        title_of(number, reported));
    for (const RequirementRow& row : rows) {
      html += "<tr>";
      for (const auto& [head, cell] : cells_of(row, reported))
        html += fmt::format("<td class=\"text\" data-head=\"{}\">{}</td>", document::markup(head), cell);
      html += "</tr>\n";
    }
  }
  return html + "</tbody></table>\n";
}

PageSection first_screen(const ReportedStudy& reported, const FirstScreenParts& parts) {
  const Conclusions conclusions = conclusions_of(reported);
  const study::Study& study = reported.study;
  const std::int64_t point = reported.chosen.point;
  const std::vector<summary::CellOfPoint> claims =
      parts.claims.empty() ? claims_of_chosen(reported) : parts.claims;
  const std::string headline = parts.headline.empty() ? conclusions.headline : parts.headline;
  const std::string margins = parts.margins.empty() ? loops_html(study, point) : parts.margins;
  return {"overview",
          "",
          parts.warnings +
              fmt::format("<p class=\"headline {}\">{}</p>\n", style_of(claims),
                          document::prose_markup(headline)) +
              diagram_html(study, point) + part_html("Requirements", requirements_html(reported, claims)) +
              lines_html(conclusions.lines) + "<div class=\"columns\">\n" +
              part_html("Gains", study.open_loop ? "" : gains_html(study, point)) +
              part_html("Margins of the linear loops", margins) +
              part_html("Assumptions", assumptions_html(study, point)) + "</div>\n",
          {}};
}

std::string axis_html(const study::Study& study, std::int64_t point) {
  return diagram_html(study, point) + part_html("Assumptions", assumptions_html(study, point));
}

}  // namespace zerocount::report
