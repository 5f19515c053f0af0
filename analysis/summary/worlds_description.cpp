#include "analysis/summary/worlds_description.hpp"

#include <optional>
#include <string>

#include "analysis/goal/goal_description.hpp"

namespace zerocount::summary {
namespace {

using document::Description;
using document::Notation;

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
      .value({.key = "worst_world", .meaning = "index of the worst world"}, &worlds::RatesOfWorlds::worst)
      .value({.key = "best_world", .meaning = "index of the best world"}, &worlds::RatesOfWorlds::best);
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

void add_number_of_worlds(Description<WorldsReading>& description, goal::Status status) {
  const std::string word(goal::text_of(status));
  description.value({.key = word, .meaning = "worlds in which the goal is " + word, .optional = true},
                    [status](const WorldsReading& r) -> std::optional<std::size_t> {
                      if (!r.point.goal) return {};
                      return goal::worlds_that(status, *r.point.goal).size();
                    });
}

}  // namespace

Description<WorldsReading> worlds_description() {
  using Reading = const WorldsReading&;
  Description<WorldsReading> description;
  description.value({.key = "n", .meaning = "number of worlds"}, [](Reading r) { return r.point.bad.size(); })
      .object({.key = "success", .meaning = "rates of success by world"}, rates_description(),
              [](Reading r) { return r.point.success; })
      .value({.key = "success_rates", .meaning = "rate of success of each world", .unit = "1"},
             [](Reading r) { return rates_of(r.point); })
      .value({.key = "goal_rates",
              .meaning = "proportion of moves of each world that meet the goal",
              .unit = "1",
              .optional = true},
             [](Reading r) {
               return of_verdicts(r.point, [](const goal::WorldVerdict& w) { return w.moves.value; });
             })
      .value({.key = "goal_status",
              .meaning = "verdict of each world",
              .words = goal::status_words(),
              .optional = true},
             [](Reading r) {
               return of_verdicts(r.point,
                                  [](const goal::WorldVerdict& w) { return goal::text_of(w.status); });
             });
  for (const goal::Status status : {goal::Status::met, goal::Status::missed, goal::Status::undecided})
    add_number_of_worlds(description, status);
  return description
      .value({.key = "bad_worlds", .meaning = "indices of the worlds that fall short"},
             [](Reading r) { return bad_worlds_of(r.point); })
      .object({.key = "rule", .meaning = "what the bad worlds have in common"}, rule_description(),
              [](Reading r) -> std::optional<RuleReading> {
                if (!r.point.rule) return {};
                return RuleReading{*r.point.rule, r.inputs};
              });
}

}  // namespace zerocount::summary
