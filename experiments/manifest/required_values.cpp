#include "experiments/manifest/required_values.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "experiments/manifest/manifest_keys.hpp"
#include "experiments/rules/effect_rules.hpp"

namespace zerocount::manifest {
namespace {

// Whether the manifest gives the slot a value at every point.
bool given_everywhere(const PlanPlaces& places, const study::StudyPlan& plan, std::size_t slot) {
  if (places.written[slot]) return true;
  return std::any_of(plan.axes.begin(), plan.axes.end(), [slot](const study::PlanAxis& axis) {
    for (std::size_t option = 0; option < study::option_count(axis); ++option) {
      const auto begin = axis.assignments.begin() + axis.first[option];
      const auto end = axis.assignments.begin() + axis.first[option + 1];
      if (std::none_of(begin, end, [slot](const study::Assignment& a) { return a.slot == slot; }))
        return false;
    }
    return true;
  });
}

bool has_effect(const study::StudyPlan& plan, const std::vector<rules::EffectRule>& rules,
                const parameters::Parameter& parameter) {
  return std::all_of(rules.begin(), rules.end(), [&](const rules::EffectRule& rule) {
    const bool covers = std::any_of(rule.keys.begin(), rule.keys.end(),
                                    [&](std::string_view key) { return is_within(parameter.name, key); });
    return !covers || rules::can_have_effect(plan, rule);
  });
}

// Whether the coarse encoder is used. If not, that of a linear axis has the resolution of the fine one.
bool uses_coarse_encoder(const study::StudyPlan& plan) {
  const auto is_coarse = [](const study::ValueLimits& encoder) {
    return encoder.high == static_cast<double>(loop::EncoderChoice::coarse);
  };
  const auto is_positive = [](const study::ValueLimits& error) { return error.high > 0.0; };
  return study::holds_somewhere(plan, "controller.encoder", is_coarse) ||
         study::holds_somewhere(plan, "controller.coarse.encoder", is_coarse) ||
         study::holds_somewhere(plan, "encoder.coarse_errors.interpolation", is_positive) ||
         study::holds_somewhere(plan, "encoder.coarse_errors.noise", is_positive) ||
         study::holds_somewhere(plan, "encoder.coarse_errors.missed", is_positive);
}

std::string why_required(const parameters::Parameter& parameter) {
  if (!parameters::has_default(parameter)) return "the key is missing";
  return fmt::format("the key is missing, and its default, {} {}, has another unit",
                     parameters::default_value(parameter), parameter.unit);
}

bool is_required(const study::StudyPlan& plan, const std::vector<rules::EffectRule>& rules,
                 const parameters::Parameter& parameter) {
  if (!parameters::exists_on(parameter, plan.units.axis)) return false;
  if (parameters::has_default(parameter)) {
    return !parameters::default_holds(parameter, plan.units) && has_effect(plan, rules, parameter);
  }
  if (!parameter.only_on) return false;  // required values of the command are checked with its form
  return parameter.name != "encoder.coarse_resolution" || uses_coarse_encoder(plan);
}

}  // namespace

void check_required_values(const PlanPlaces& places, Reading& reading) {
  const study::StudyPlan& plan = reading.plan;
  const std::vector<rules::EffectRule> rules = rules::effect_rules(plan);
  const auto table = parameters::parameter_table();
  for (std::size_t row = 0; row < table.size(); ++row) {
    const parameters::Parameter& parameter = table[row];
    if (!is_required(plan, rules, parameter) || given_everywhere(places, plan, row)) continue;
    reading.problems.add(places.base[row], parameter.name, why_required(parameter),
                         fmt::format("its value in {}", parameters::unit_of(parameter, plan.units)));
  }
}

}  // namespace zerocount::manifest
