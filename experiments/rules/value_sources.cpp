#include "experiments/rules/value_sources.hpp"

#include <algorithm>
#include <optional>

#include "experiments/rules/value_rules.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::rules {
namespace {

/// Whether the default of the parameter stands for an effect that is absent: 0, false, or the word "none".
bool is_absent(const parameters::Parameter& parameter) {
  const double value = parameters::default_value(parameter);
  return parameter.kind != parameters::ParameterKind::enumeration &&
         (value == 0.0 || value == parameter.none);
}

/// Whether the trials depend on the default of the slot (a parameter in the plan): the manifest does not give
/// it, and it has an effect.
bool is_assumed(const study::StudyPlan& plan, const std::vector<EffectRule>& rules, std::size_t slot) {
  const parameters::Parameter& parameter = plan.table.rows[slot];
  return parameters::has_default(parameter) && parameters::exists_on(parameter, plan.units.axis) &&
         plan.base[slot].kind != study::Value::Kind::derived && !is_absent(parameter) &&
         has_effect(plan, rules, parameter.name);
}

std::optional<ValueSource> source_of(const study::StudyPlan& plan, const std::vector<EffectRule>& rules,
                                     std::size_t slot) {
  if (std::ranges::find(plan.sampled_slots, slot) != plan.sampled_slots.end()) return ValueSource::sampled;
  if (plan.given[slot])
    return parameters::is_measured(plan.table.rows[slot].name) ? ValueSource::measured : ValueSource::given;
  if (is_assumed(plan, rules, slot)) return ValueSource::assumed;
  return std::nullopt;
}

}  // namespace

std::vector<SourcedValue> value_sources(const study::StudyPlan& plan) {
  const std::vector<EffectRule> rules = effect_rules(plan);
  std::vector<SourcedValue> values;
  for (const std::size_t slot : study::slots_in_table_order(plan.table)) {
    if (plan.table.rows[slot].name.starts_with("command.")) continue;
    if (const std::optional<ValueSource> source = source_of(plan, rules, slot))
      values.push_back({slot, *source});
  }
  return values;
}

}  // namespace zerocount::rules
