#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/summary/summary_parts.hpp"

namespace zerocount::summary {
namespace {

using Json = nlohmann::ordered_json;

void add_proportion(Json& json, const std::string& name, const goal::BoundedProportion& proportion) {
  json[name] = proportion.value;
  json[name + "_low"] = proportion.low;
  json[name + "_high"] = proportion.high;
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

}  // namespace

std::vector<std::optional<goal::Verdict>> goal_verdicts(const StudySummary& summary) {
  std::vector<std::optional<goal::Verdict>> verdicts;
  for (const std::int64_t index : complete_points(summary)) {
    const measures::PointSummary& point = summary.points[static_cast<std::size_t>(index)];
    verdicts.emplace_back();
    if (point.trials > 0) verdicts.back() = verdict_on(summary.question, *point.goal);
  }
  return verdicts;
}

Json verdict_json(const study::Goal& goal, const goal::Verdict& verdict, bool on_rigs) {
  Json json{{"status", goal::text_of(verdict.status)}};
  add_proportion(json, "rate", verdict.moves);
  if (goal.machines) add_proportion(json, "machines", verdict.machines);
  if (on_rigs) json["rigs_without_miss"] = verdict.rigs_without_miss;
  return json;
}

measures::SummarySection goal_section(const StudySummary& summary) {
  const std::vector<std::optional<goal::Verdict>> verdicts = goal_verdicts(summary);
  measures::SummarySection section{.key = "goal", .json = {}, .columns = {}};
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    section.json.push_back(verdicts[i] ? verdict_json(*summary.question.claim(), *verdicts[i],
                                                      !summary.points[i].goal->rigs.empty())
                                       : Json());
  }
  const std::string where = summary.question.worlds > 0 ? " in the worst world" : "";
  add_columns(section.columns, "goal_rate", "proportion of moves that meet the goal" + where, verdicts,
              &goal::Verdict::moves);
  if (summary.question.claim()->machines) {
    add_columns(section.columns, "goal_machines", "proportion of machines that meet the goal" + where,
                verdicts, &goal::Verdict::machines);
  }
  return section;
}

}  // namespace zerocount::summary
