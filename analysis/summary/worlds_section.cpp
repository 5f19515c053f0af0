#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/document/answer.hpp"
#include "analysis/summary/shown_points.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/summary/worlds_description.hpp"
#include "analysis/text/percent.hpp"

namespace zerocount::summary {
namespace {

using Json = nlohmann::ordered_json;
using Worlds = std::optional<worlds::PointWorlds>;

std::int64_t worlds_with(goal::Status status, const worlds::PointWorlds& point) {
  return std::ssize(goal::worlds_that(status, *point.goal));
}

void add_column(std::vector<layout::PointColumn>& columns, std::string name, std::string meaning,
                const std::vector<Worlds>& points, const auto& value) {
  layout::PointColumn column{std::move(name), "1", std::move(meaning), {}};
  for (const Worlds& point : points)
    column.values.push_back(point ? static_cast<double>(value(*point)) : statistics::unknown);
  columns.push_back(std::move(column));
}

std::vector<layout::PointColumn> columns_of(const std::vector<Worlds>& points, bool has_goal) {
  using Point = const worlds::PointWorlds&;
  std::vector<layout::PointColumn> columns;
  add_column(columns, "worlds_success_worst", "success rate of the world with the lowest", points,
             [](Point p) { return p.success.lowest.value; });
  add_column(columns, "worlds_success_worst_low",
             "one-sided lower bound of the lowest success rate of a world", points,
             [](Point p) { return p.success.lowest.low; });
  add_column(columns, "worlds_success_worst_high",
             "one-sided upper bound of the lowest success rate of a world", points,
             [](Point p) { return p.success.lowest.high; });
  add_column(columns, "worlds_success_median", "median of the success rates of the worlds", points,
             [](Point p) { return p.success.median; });
  add_column(columns, "worlds_success_best", "success rate of the world with the highest", points,
             [](Point p) { return p.success.worlds[p.success.best].value; });
  if (!has_goal) return columns;
  add_column(columns, "worlds_goal_met", "worlds in which the goal is met", points,
             [](Point p) { return worlds_with(goal::Status::met, p); });
  add_column(columns, "worlds_goal_missed", "worlds in which the goal is missed", points,
             [](Point p) { return worlds_with(goal::Status::missed, p); });
  return columns;
}

void add_cells(std::vector<text::TextColumn>& columns, std::string head, const std::vector<Worlds>& points,
               const auto& cell) {
  text::TextColumn column{std::move(head), true, {}};
  for (const Worlds& point : points) {
    if (point) column.cells.push_back(cell(*point));
  }
  columns.push_back(std::move(column));
}

text::PointTable table_of(const std::vector<Worlds>& points, const std::vector<std::string>& labels,
                          const goal::Question& question) {
  using Point = const worlds::PointWorlds&;
  text::PointTable table{{{"point", false, {}}}, {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i]) continue;
    table.columns[0].cells.push_back(text::printable(labels[i]));
    table.points.push_back(static_cast<std::int64_t>(i));
  }
  std::vector<text::TextColumn>& columns = table.columns;
  add_cells(columns, fmt::format("{} worst", goal::judged_head(question)), points,
            [](Point p) { return text::percent_near(p.asked.lowest.value); });
  add_cells(columns, "bounds", points, [](Point p) {
    return fmt::format("[{}]", text::percent_bounds(p.asked.lowest.low, p.asked.lowest.high));
  });
  add_cells(columns, "median", points, [](Point p) { return text::percent_near(p.asked.median); });
  add_cells(columns, "best", points,
            [](Point p) { return text::percent_near(p.asked.worlds[p.asked.best].value); });
  if (!question.claim()) return table;
  for (const goal::Status status : {goal::Status::met, goal::Status::missed, goal::Status::undecided}) {
    add_cells(columns, fmt::format("goal {}", goal::text_of(status)), points,
              [status](Point p) { return fmt::format("{}", worlds_with(status, p)); });
  }
  return table;
}

/// ", or where creep_rate > 2e-05 rad/s, which are the same worlds".
std::string same_text(const worlds::WorldRule& rule, const std::vector<worlds::WorldInput>& inputs) {
  std::vector<std::string> conditions;
  for (const worlds::Condition& one : rule.same) conditions.push_back(worlds::text_of(one, inputs));
  if (conditions.empty()) return "";
  return fmt::format(", or where {}, which are the same worlds", fmt::join(conditions, ", or "));
}

/// "; creep_rate: speed at which …" of each derived quantity in the rule.
std::string meanings_text(const worlds::WorldRule& rule, const std::vector<worlds::WorldInput>& inputs) {
  std::string text;
  for (const std::vector<worlds::Condition>* conditions : {&rule.conditions, &rule.same}) {
    for (const worlds::Condition& one : *conditions) {
      const worlds::WorldInput& input = inputs[one.input];
      if (input.is_derived()) text += fmt::format("; {}: {}", input.name, input.meaning);
    }
  }
  return text;
}

}  // namespace

Worlds worlds_of_point(const StudySummary& summary, std::int64_t point, std::size_t chosen_from) {
  const measures::PointSummary& one = summary.points[static_cast<std::size_t>(point)];
  if (!one.worlds) return std::nullopt;
  for (const measures::MoveCounts& world : measures::in_worlds(one.worlds->succeeded)) {
    if (world.moves == 0) return std::nullopt;  // of an unfinished run
  }
  return worlds::point_worlds(one, summary.question, summary.world_inputs[static_cast<std::size_t>(point)],
                              summary.seed, summary.confidence, chosen_from);
}

std::string bad_worlds_sentence(const worlds::PointWorlds& point,
                                const std::vector<worlds::WorldInput>& inputs,
                                const goal::Question& question) {
  const auto bad = std::count(point.bad.begin(), point.bad.end(), true);
  const std::int64_t all = std::ssize(point.bad);
  const std::string_view what = goal::words_of(question).falls_short;
  if (bad == 0 || bad == all) return fmt::format("{} of {} worlds {}", bad == 0 ? "none" : "all", all, what);
  if (!point.rule) {
    return fmt::format(
        "{} of {} worlds {}, and no rule on one or two parameters tells them from the others (at a "
        "significance of {})",
        bad, all, what, text::percent(worlds::significance_of_rules));
  }
  const worlds::WorldRule& rule = *point.rule;
  return fmt::format(
      "{} of {} worlds {}: where {} ({} of these {}, and {} of the other {}: {} of worlds named wrongly; by "
      "chance with probability {:.2g}){}; what separates them need not be the cause{}",
      bad, all, what, worlds::text_of(rule, inputs), rule.bad_named, rule.bad, rule.good_named, rule.good,
      text::percent_near(rule.error_rate()), rule.p_value, same_text(rule, inputs),
      meanings_text(rule, inputs));
}

measures::SummarySection worlds_section(const StudySummary& summary) {
  std::vector<Worlds> points;
  for (std::int64_t point = 0; point < std::ssize(summary.points); ++point)
    points.push_back(worlds_of_point(summary, point));
  const std::vector<std::string> labels = short_labels(summary.labels, summary.axes);
  measures::SummarySection section{
      .key = "worlds",
      .json = {},
      .columns = columns_of(points, summary.question.claim().has_value()),
      .title =
          fmt::format("by world: the lowest, median and highest rate of {} worlds", summary.question.worlds)};
  section.tables.push_back(table_of(points, labels, summary.question));
  constexpr std::size_t max_sentences = 12;
  std::size_t sentences = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    section.json.push_back(
        points[i] ? document::json(worlds_description(), {*points[i], summary.world_inputs[i]}) : Json());
    if (points[i] && ++sentences <= max_sentences) {
      section.note += fmt::format("{}: {}\n", text::printable(labels[i]),
                                  bad_worlds_sentence(*points[i], summary.world_inputs[i], summary.question));
    }
  }
  if (sentences > max_sentences)
    section.note +=
        fmt::format("and {} more points (--format json has their rules)\n", sentences - max_sentences);
  section.note +=
      fmt::format("bounds of one side each, of the lowest rate of all worlds, with {} confidence\n",
                  text::percent(goal::confidence_of(summary.question, summary.confidence)));
  section.open = true;
  return section;
}

}  // namespace zerocount::summary
