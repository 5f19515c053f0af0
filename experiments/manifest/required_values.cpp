#include "experiments/manifest/required_values.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "experiments/manifest/manifest_keys.hpp"
#include "experiments/rules/effect_rules.hpp"

namespace zerocount {
namespace {

// Whether the manifest gives the slot a value at every point.
bool given_everywhere(const PlanPlaces& places, const StudyPlan& plan, std::size_t slot) {
  if (places.written[slot]) return true;
  return std::any_of(plan.axes.begin(), plan.axes.end(), [slot](const PlanAxis& axis) {
    for (std::size_t option = 0; option < option_count(axis); ++option) {
      const auto begin = axis.assignments.begin() + axis.first[option];
      const auto end = axis.assignments.begin() + axis.first[option + 1];
      if (std::none_of(begin, end, [slot](const Assignment& a) { return a.slot == slot; })) return false;
    }
    return true;
  });
}

bool has_effect(const StudyPlan& plan, const std::vector<EffectRule>& rules, const Parameter& parameter) {
  return std::all_of(rules.begin(), rules.end(), [&](const EffectRule& rule) {
    const bool covers = std::any_of(rule.keys.begin(), rule.keys.end(),
                                    [&](std::string_view key) { return is_within(parameter.name, key); });
    return !covers || can_have_effect(plan, rule);
  });
}

// Whether the coarse encoder is used. If not, that of a linear axis has the resolution of the fine one.
bool uses_coarse_encoder(const StudyPlan& plan) {
  const auto is_coarse = [](std::span<const ValueLimits> l) {
    return l[0].high == static_cast<double>(EncoderChoice::coarse);
  };
  const auto is_positive = [](std::span<const ValueLimits> l) { return l[0].high > 0.0; };
  const auto somewhere = [&plan](std::string_view name, const auto& holds) {
    return holds_somewhere(plan, {&name, 1}, holds);
  };
  return somewhere("controller.encoder", is_coarse) || somewhere("controller.coarse.encoder", is_coarse) ||
         somewhere("encoder.coarse_errors.interpolation", is_positive) ||
         somewhere("encoder.coarse_errors.noise", is_positive) ||
         somewhere("encoder.coarse_errors.missed", is_positive);
}

std::string why_required(const Parameter& parameter) {
  if (!has_default(parameter)) return "the key is missing";
  return fmt::format("the key is missing, and its default, {} {}, has another unit", default_value(parameter),
                     parameter.unit);
}

bool is_required(const StudyPlan& plan, const std::vector<EffectRule>& rules, const Parameter& parameter) {
  if (!exists_on(parameter, plan.units.axis)) return false;
  if (has_default(parameter)) {
    return !default_holds(parameter, plan.units) && has_effect(plan, rules, parameter);
  }
  if (!parameter.only_on) return false;  // required values of the command are checked with its form
  return parameter.name != "encoder.coarse_resolution" || uses_coarse_encoder(plan);
}

}  // namespace

void check_required_values(const PlanPlaces& places, Reading& reading) {
  const StudyPlan& plan = reading.plan;
  const std::vector<EffectRule> rules = effect_rules(plan);
  const auto table = parameter_table();
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Parameter& parameter = table[row];
    if (!is_required(plan, rules, parameter) || given_everywhere(places, plan, row)) continue;
    reading.problems.add(places.base[row], parameter.name, why_required(parameter),
                         fmt::format("its value in {}", unit_of(parameter, plan.units)));
  }
}

}  // namespace zerocount
