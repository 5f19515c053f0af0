#include "analysis/summary/worlds_of_point.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/goal/goal_description.hpp"
#include "analysis/text/percent.hpp"

namespace zerocount::summary {
namespace {

using document::Description;
using document::Notation;
using document::Shown;

struct RuleReading {
  const worlds::WorldRule& rule;
  const std::vector<worlds::WorldInput>& inputs;
};

struct ConditionReading {
  const worlds::Condition& condition;
  const worlds::WorldInput& input;
};

std::vector<ConditionReading> readings(const std::vector<worlds::Condition>& conditions,
                                       const std::vector<worlds::WorldInput>& inputs) {
  std::vector<ConditionReading> readings;
  readings.reserve(conditions.size());
  for (const worlds::Condition& one : conditions) readings.push_back({one, inputs[one.input]});
  return readings;
}

Description<ConditionReading> condition_description() {
  using Reading = const ConditionReading&;
  return Description<ConditionReading>()
      .value({.key = "parameter", .meaning = "dotted path, or name of a derived quantity"},
             [](Reading r) { return r.input.name; })
      .value({.key = "relation", .meaning = "sign between parameter and value", .words = {">", "<"}},
             [](Reading r) { return r.condition.above ? ">" : "<"; })
      .value({.key = "value", .meaning = "threshold, in the unit of the parameter"},
             [](Reading r) { return r.condition.threshold; });
}

Description<RuleReading> rule_description() {
  using Reading = const RuleReading&;
  return Description<RuleReading>()
      .value({.key = "text", .meaning = "the rule in words"},
             [](Reading r) { return worlds::text_of(r.rule, r.inputs); })
      .table({.key = "conditions", .meaning = "conditions of the rule"}, condition_description(),
             [](Reading r) { return readings(r.rule.conditions, r.inputs); })
      .table({.key = "same", .meaning = "conditions each of which alone names the same worlds"},
             condition_description(), [](Reading r) { return readings(r.rule.same, r.inputs); })
      .value({.key = "joined_by", .meaning = "how the conditions are joined", .words = {"and", "or"}},
             [](Reading r) { return r.rule.all ? "and" : "or"; })
      .value({.key = "bad_named", .meaning = "bad worlds that the rule names"},
             [](Reading r) { return r.rule.bad_named; })
      .value({.key = "others_named", .meaning = "other worlds that it names"},
             [](Reading r) { return r.rule.good_named; })
      .value({.key = "error_rate", .meaning = "proportion of worlds named wrongly", .unit = "1"},
             [](Reading r) { return r.rule.error_rate(); })
      .value({.key = "p_value", .meaning = "probability of such a rule by chance", .unit = "1"},
             [](Reading r) { return r.rule.p_value; });
}

Description<worlds::RatesOfWorlds> rates_description() {
  using Rates = const worlds::RatesOfWorlds&;
  return Description<worlds::RatesOfWorlds>()
      .value({.key = "worst", .meaning = "rate of the worst world, with one-sided bounds", .unit = "1"},
             [](Rates r) { return goal::bounded(r.lowest); })
      .value({.key = "median", .meaning = "median of the rates", .unit = "1"}, &worlds::RatesOfWorlds::median)
      .value({.key = "best", .meaning = "rate of the best world", .unit = "1"},
             [](Rates r) { return r.worlds[r.best].value; })
      .value({.key = "worst_world", .meaning = "index of the worst world", .shown = Shown::in_json},
             &worlds::RatesOfWorlds::worst)
      .value({.key = "best_world", .meaning = "index of the best world", .shown = Shown::in_json},
             &worlds::RatesOfWorlds::best);
}

std::vector<double> rates_of(const worlds::PointWorlds& point) {
  std::vector<double> rates;
  for (const goal::BoundedProportion& world : point.success.worlds) rates.push_back(world.value);
  return rates;
}

/// One value for each world's verdict; nothing without a goal.
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

/// Of the rate that the study is judged by, which people are shown.
void add_judged_rates(Description<WorldsReading>& description, const goal::Question& question) {
  using Reading = const WorldsReading&;
  const auto column = [](std::string heading) {
    return document::Item{.heading = std::move(heading), .unit = "1", .notation = Notation::percent};
  };
  description
      .value(column(fmt::format("{} worst [bounds]", goal::judged_head(question))),
             [](Reading r) { return goal::bounded(r.point.asked.lowest); })
      .value(column("median"), [](Reading r) { return r.point.asked.median; })
      .value(column("best"), [](Reading r) { return r.point.asked.worlds[r.point.asked.best].value; });
}

/// @param in_csv whether summaries have a column of it
void add_number_of_worlds(Description<WorldsReading>& description, goal::Status status, bool in_csv) {
  const std::string word(goal::text_of(status));
  description.value({.key = word,
                     .heading = "goal " + word,
                     .meaning = "worlds in which the goal is " + word,
                     .shown = in_csv ? Shown::everywhere : Shown::not_in_csv,
                     .column = "worlds_goal_" + word,
                     .optional = true},
                    [status](const WorldsReading& r) -> std::optional<std::size_t> {
                      if (!r.point.goal) return {};
                      return goal::worlds_that(status, *r.point.goal).size();
                    });
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

Description<WorldsReading> worlds_description(const goal::Question& question) {
  using Reading = const WorldsReading&;
  Description<WorldsReading> description;
  add_judged_rates(description, question);
  description
      .value({.key = "n", .meaning = "number of worlds", .shown = Shown::in_json},
             [](Reading r) { return r.point.bad.size(); })
      .object({.key = "success", .meaning = "rates of success by world"}, rates_description(),
              [](Reading r) { return r.point.success; })
      .value({.key = "success_rates",
              .meaning = "rate of success of each world",
              .unit = "1",
              .shown = Shown::in_json},
             [](Reading r) { return rates_of(r.point); })
      .value({.key = "goal_rates",
              .meaning = "proportion of moves of each world that meet the goal",
              .unit = "1",
              .shown = Shown::in_json,
              .optional = true},
             [](Reading r) {
               return of_verdicts(r.point, [](const goal::WorldVerdict& w) { return w.moves.value; });
             })
      .value({.key = "goal_status",
              .meaning = "verdict of each world",
              .shown = Shown::in_json,
              .words = goal::status_words(),
              .optional = true},
             [](Reading r) {
               return of_verdicts(r.point,
                                  [](const goal::WorldVerdict& w) { return goal::text_of(w.status); });
             });
  if (question.claim()) {
    for (const goal::Status status : {goal::Status::met, goal::Status::missed, goal::Status::undecided})
      add_number_of_worlds(description, status, status != goal::Status::undecided);
  }
  return description
      .value(
          {.key = "bad_worlds", .meaning = "indices of the worlds that fall short", .shown = Shown::in_json},
          [](Reading r) { return bad_worlds_of(r.point); })
      .object({.key = "rule", .meaning = "what the bad worlds have in common", .shown = Shown::in_json},
              rule_description(),
              [](Reading r) -> std::optional<RuleReading> {
                if (!r.point.rule) return {};
                return RuleReading{*r.point.rule, r.inputs};
              })
      .sentence([](Reading r) { return bad_worlds_sentence(r.point, r.inputs, r.question); });
}

}  // namespace zerocount::summary
