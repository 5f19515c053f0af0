#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/goal/question_text.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"

namespace zerocount::summary {
namespace {

using document::Description;
using document::Notation;
using document::Visibility;

struct NamedRule {
  const worlds::WorldRule& rule;
  const std::vector<worlds::WorldInput>& inputs;
};

struct NamedCondition {
  const worlds::Condition& condition;
  const worlds::WorldInput& input;
};

std::vector<NamedCondition> readings(const std::vector<worlds::Condition>& conditions,
                                     const std::vector<worlds::WorldInput>& inputs) {
  std::vector<NamedCondition> readings;
  readings.reserve(conditions.size());
  for (const worlds::Condition& one : conditions) readings.push_back({one, inputs[one.input]});
  return readings;
}

Description<NamedCondition> condition_description() {
  return Description<NamedCondition>()
      .value(document::in_data("parameter", "dotted path, or name of a derived quantity"),
             [](const NamedCondition& r) { return r.input.name; })
      .value({.key = "relation", .meaning = "sign between parameter and value", .words = {">", "<"}},
             [](const NamedCondition& r) { return r.condition.above ? ">" : "<"; })
      .value(document::in_data("value", "threshold, in the unit of the parameter"),
             [](const NamedCondition& r) { return r.condition.threshold; });
}

Description<NamedRule> rule_description() {
  return Description<NamedRule>()
      .value(document::in_data("text", "the rule in words"),
             [](const NamedRule& r) { return worlds::text_of(r.rule, r.inputs); })
      .table({.key = "conditions", .meaning = "conditions of the rule"}, condition_description(),
             [](const NamedRule& r) { return readings(r.rule.conditions, r.inputs); })
      .table({.key = "same", .meaning = "conditions each of which alone names the same worlds"},
             condition_description(), [](const NamedRule& r) { return readings(r.rule.same, r.inputs); })
      .value({.key = "joined_by", .meaning = "how the conditions are joined", .words = {"and", "or"}},
             [](const NamedRule& r) { return r.rule.all ? "and" : "or"; })
      .value(document::in_data("bad_named", "bad worlds that the rule names"),
             [](const NamedRule& r) { return r.rule.bad_named; })
      .value(document::in_data("others_named", "other worlds that it names"),
             [](const NamedRule& r) { return r.rule.good_named; })
      .value(document::in_data("error_rate", "proportion of worlds named wrongly", "1"),
             [](const NamedRule& r) { return r.rule.error_rate(); })
      .value(document::in_data("p_value", "probability of such a rule by chance", "1"),
             [](const NamedRule& r) { return r.rule.p_value; });
}

Description<worlds::RatesOfWorlds> rates_description() {
  using Rates = const worlds::RatesOfWorlds&;
  return Description<worlds::RatesOfWorlds>()
      .value(document::in_data("worst", "rate of the worst world, with one-sided bounds", "1"),
             [](Rates r) { return goal::bounded(r.lowest); })
      .value(document::in_data("median", "median of the rates", "1"), &worlds::RatesOfWorlds::median)
      .value(document::in_data("best", "rate of the best world", "1"),
             [](Rates r) { return r.worlds[r.best].value; })
      .value({.key = "worst_world", .meaning = "index of the worst world", .shown = Visibility::in_json},
             &worlds::RatesOfWorlds::worst)
      .value({.key = "best_world", .meaning = "index of the best world", .shown = Visibility::in_json},
             &worlds::RatesOfWorlds::best);
}

std::vector<double> rates_of(const worlds::PointWorlds& point) {
  std::vector<double> rates;
  for (const goal::BoundedProportion& world : point.success.worlds) rates.push_back(world.value);
  return rates;
}

/// [world] The result of the function `value` for the verdict on each world (a draw of what all machines
/// share); nothing without a goal.
template <class Value>
auto of_verdicts(const worlds::PointWorlds& point, Value value) {
  using Values = std::vector<std::invoke_result_t<Value, const goal::WorldVerdict&>>;
  if (!point.goal) return std::optional<Values>();
  Values values;
  for (const goal::WorldVerdict& world : point.goal->worlds) values.push_back(value(world));
  return std::optional(std::move(values));
}

std::vector<std::size_t> bad_worlds_of(const worlds::PointWorlds& point) {
  std::vector<std::size_t> bad;
  for (std::size_t world = 0; world < point.bad.size(); ++world) {
    if (point.bad[world]) bad.push_back(world);
  }
  return bad;
}

/// Adds table columns for people: the rate by which the study is judged in the worst, the median and the best
/// world (draw of what all machines share).
void add_judged_rates(Description<WorldsAtPoint>& description, const goal::Question& question) {
  const auto column = [](std::string heading) {
    return document::Item{.heading = std::move(heading), .unit = "1", .notation = Notation::percent};
  };
  description
      .value(column(fmt::format("{} worst [bounds]", goal::head_of_judged_rate(question))),
             [](const WorldsAtPoint& r) { return goal::bounded(r.point.asked.lowest); })
      .value(column("median"), [](const WorldsAtPoint& r) { return r.point.asked.median; })
      .value(column("best"),
             [](const WorldsAtPoint& r) { return r.point.asked.worlds[r.point.asked.best].value; });
}

/// Adds an item with the number of worlds (draws of what all machines share) in which the goal has this
/// status.
/// @param in_csv whether the CSV has a column for the number
void add_number_of_worlds(Description<WorldsAtPoint>& description, goal::Status status, bool in_csv) {
  const std::string word(goal::text_of(status));
  description.value({.key = word,
                     .heading = "goal " + word,
                     .meaning = "worlds in which the goal is " + word,
                     .shown = in_csv ? Visibility::everywhere : Visibility::not_in_csv,
                     .column = "worlds_goal_" + word,
                     .optional = true},
                    [status](const WorldsAtPoint& r) -> std::optional<std::size_t> {
                      if (!r.point.goal) return {};
                      return goal::worlds_that(status, *r.point.goal).size();
                    });
}

/// Text on other conditions that separate the same worlds as the rule: ", or where creep_rate > 2e-05 rad/s,
/// which are the same worlds". Empty if there are none.
std::string same_text(const worlds::WorldRule& rule, const std::vector<worlds::WorldInput>& inputs) {
  std::vector<std::string> conditions;
  for (const worlds::Condition& one : rule.same) conditions.push_back(worlds::text_of(one, inputs));
  if (conditions.empty()) return "";
  return fmt::format(", or where {}, which are the same worlds", fmt::join(conditions, ", or "));
}

/// Explanations of the derived quantities in the rule: "; creep_rate: speed at which …" for each; empty
/// without any.
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

std::optional<worlds::PointWorlds> worlds_of_point(const StudySummary& summary, std::int64_t point,
                                                   std::size_t chosen_from) {
  const measures::PointSummary& one = summary.points[static_cast<std::size_t>(point)];
  if (!one.trials_of_groups || summary.question.worlds == 0) return std::nullopt;
  for (const measures::MoveCounts& world : one.trials_of_groups->succeeded.by_world()) {
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
  const std::string_view what = question.goal() ? "fall short of the goal by their observed rates"
                                                : "are shown to succeed less often than the median world";
  if (bad == 0 || bad == all) return fmt::format("{} of {} worlds {}", bad == 0 ? "none" : "all", all, what);
  if (!point.rule) {
    return fmt::format(
        "{} of {} worlds {}, and no rule on one or two parameters distinguishes them from the others (at a "
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

Description<WorldsAtPoint> worlds_description(const goal::Question& question) {
  Description<WorldsAtPoint> description;
  add_judged_rates(description, question);
  description
      .value({.key = "n", .meaning = "number of worlds", .shown = Visibility::in_json},
             [](const WorldsAtPoint& r) { return r.point.bad.size(); })
      .object({.key = "success", .meaning = "rates of success by world"}, rates_description(),
              [](const WorldsAtPoint& r) { return r.point.success; })
      .value({.key = "success_rates",
              .meaning = "rate of success of each world",
              .unit = "1",
              .shown = Visibility::in_json},
             [](const WorldsAtPoint& r) { return rates_of(r.point); })
      .value({.key = "goal_rates",
              .meaning = "proportion of moves of each world that meet the goal",
              .unit = "1",
              .shown = Visibility::in_json,
              .optional = true},
             [](const WorldsAtPoint& r) {
               return of_verdicts(r.point, [](const goal::WorldVerdict& w) { return w.moves.value; });
             })
      .value({.key = "goal_status",
              .meaning = "verdict of each world",
              .shown = Visibility::in_json,
              .words = goal::status_words(),
              .optional = true},
             [](const WorldsAtPoint& r) {
               return of_verdicts(r.point,
                                  [](const goal::WorldVerdict& w) { return goal::text_of(w.status); });
             });
  if (question.goal()) {
    for (const goal::Status status : {goal::Status::met, goal::Status::missed, goal::Status::undecided})
      add_number_of_worlds(description, status, status != goal::Status::undecided);
  }
  return description
      .value({.key = "bad_worlds",
              .meaning = "indices of the worlds that fall short",
              .shown = Visibility::in_json},
             [](const WorldsAtPoint& r) { return bad_worlds_of(r.point); })
      .object({.key = "rule", .meaning = "what the bad worlds have in common", .shown = Visibility::in_json},
              rule_description(),
              [](const WorldsAtPoint& r) -> std::optional<NamedRule> {
                if (!r.point.rule) return {};
                return NamedRule{*r.point.rule, r.inputs};
              })
      .sentence([](const WorldsAtPoint& r) { return bad_worlds_sentence(r.point, r.inputs, r.question); });
}

}  // namespace zerocount::summary
