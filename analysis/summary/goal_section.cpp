#include <algorithm>

#include <fmt/format.h>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/judged_point.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::summary {
namespace {

using Json = nlohmann::ordered_json;

/// The verdicts of the points, each on its own; nothing for a point without trials.
std::vector<std::optional<goal::Verdict>> verdicts_of(const StudySummary& summary) {
  std::vector<std::optional<goal::Verdict>> verdicts;
  for (const measures::PointSummary& point : summary.points) {
    verdicts.emplace_back();
    if (point.trials > 0) verdicts.back() = goal::judge_goal(*summary.goal, *point.goal, 1);
  }
  return verdicts;
}

void add_proportion(Json& json, const std::string& name, const goal::BoundedProportion& proportion) {
  json[name] = proportion.value;
  json[name + "_low"] = proportion.low;
  json[name + "_high"] = proportion.high;
}

Json verdict_json(const study::Goal& goal, const goal::Verdict& verdict, bool on_rigs) {
  Json json{{"status", goal::text_of(verdict.status)}};
  add_proportion(json, "rate", verdict.moves);
  if (goal.machines) add_proportion(json, "machines", verdict.machines);
  if (on_rigs) json["rigs_without_miss"] = verdict.rigs_without_miss;
  return json;
}

/// Three columns: the proportion and its bounds.
void add_columns(std::vector<layout::PointColumn>& columns, const std::string& name, const std::string& what,
                 std::span<const std::optional<goal::Verdict>> verdicts,
                 goal::BoundedProportion goal::Verdict::*proportion) {
  const auto add = [&](const std::string& suffix, const std::string& bound,
                       double goal::BoundedProportion::*number) {
    layout::PointColumn column{name + suffix, "1", bound + what, {}};
    for (const std::optional<goal::Verdict>& verdict : verdicts)
      column.values.push_back(verdict ? (*verdict).*proportion.*number : statistics::unknown);
    columns.push_back(std::move(column));
  };
  add("", "", &goal::BoundedProportion::value);
  add("_low", "one-sided lower bound of the ", &goal::BoundedProportion::low);
  add("_high", "one-sided upper bound of the ", &goal::BoundedProportion::high);
}

/// "98.2 % [97.1, 98.9]".
std::string cell_of(const goal::BoundedProportion& proportion) {
  return fmt::format("{:.4g} % [{}]", 100.0 * proportion.value,
                     text::percent_bounds(proportion.low, proportion.high));
}

std::string table_of(const StudySummary& summary, std::span<const std::optional<goal::Verdict>> verdicts) {
  std::vector<std::vector<std::string>> cells{{"point", "goal", "moves that meet it"}};
  if (summary.goal->machines) cells.front().push_back("machines that meet it");
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    if (!verdicts[i]) continue;
    cells.push_back({text::printable(summary.labels[i]), std::string(goal::text_of(verdicts[i]->status)),
                     cell_of(verdicts[i]->moves)});
    if (summary.goal->machines) cells.back().push_back(cell_of(verdicts[i]->machines));
  }
  return text::aligned_table(cells, std::vector<bool>(cells.front().size(), false));
}

}  // namespace

measures::SummarySection goal_section(const StudySummary& summary) {
  const std::vector<std::optional<goal::Verdict>> verdicts = verdicts_of(summary);
  measures::SummarySection section{.key = "goal", .json = {}, .columns = {}, .text = "", .open = true};
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    section.json.push_back(
        verdicts[i] ? verdict_json(*summary.goal, *verdicts[i], !summary.points[i].goal->rigs.empty())
                    : Json());
  }
  add_columns(section.columns, "goal_rate", "proportion of moves that meet the goal", verdicts,
              &goal::Verdict::moves);
  if (summary.goal->machines) {
    add_columns(section.columns, "goal_machines", "proportion of machines that meet the goal", verdicts,
                &goal::Verdict::machines);
  }
  section.text = fmt::format("{}\nbounds of one side each, of each point alone\n\n{}",
                             table_of(summary, verdicts), judgement_text(summary, judge_point(summary)));
  return section;
}

}  // namespace zerocount::summary
