#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/parameters/study_units.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/sections/sections.hpp"
#include "experiments/study/study.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::sections {
namespace {

/// Reads the range in which `tune` may change a parameter. Reports ends that are not in order, not allowed
/// or, if the parameter takes whole numbers, not whole.
void take_range(const yaml::Field& field, const numerics::Interval& allowed, study::FreeParameter& parameter,
                yaml::Problems& problems) {
  const auto log = yaml::find_field(field, "log");
  const yaml::Field ends = log.value_or(field);
  parameter.logarithmic = log.has_value();
  const auto low = yaml::read_real(yaml::item_of(ends, 0), allowed, problems);
  const auto high = yaml::read_real(yaml::item_of(ends, 1), allowed, problems);
  if (!low || !high) return;
  parameter.low = *low;
  parameter.high = *high;
  if (!(*low < *high))
    problems.add(ends, fmt::format("{} is not below {}", *low, *high),
                 keys::shape_of("tune.free").parts.front().expected);
  if (parameter.logarithmic && !(*low > 0.0))
    problems.add(ends, fmt::format("{} is not above 0", *low), "a logarithmic range above 0");
  if (parameter.whole && (*low != std::floor(*low) || *high != std::floor(*high)))
    problems.add(ends, "an end is not a whole number", "whole numbers");
}

/// Whether the value of the slot (a parameter in the plan) is the same number at all design points. Overrides
/// by conditions are checked elsewhere.
bool is_one_number(const study::StudyPlan& plan, std::size_t slot) {
  const auto swept = std::span(plan.axes).first(plan.axes.size() - (plan.settings_axis ? 1 : 0));
  const auto is_swept = [slot](const study::PlanAxis& axis) {
    return std::ranges::any_of(axis.assignments,
                               [slot](const study::Assignment& one) { return one.slot == slot; });
  };
  return plan.base[slot].kind == study::Value::Kind::number && !plan.base[slot].aging &&
         std::ranges::none_of(swept, is_swept);
}

void read_free(const yaml::Field& map, const study::StudyPlan& plan, study::Tuning& tuning,
               yaml::Problems& problems) {
  for (const yaml::YamlEntry& entry : map.node->entries) {
    const yaml::Field field = yaml::entry_of(map, entry);
    const auto slots = study::find_slots(entry.key, plan.table);
    if (!slots || slots->list) {
      problems.add(entry.place, field.path,
                   is_of_spectrum(plan, entry.key)
                       ? fmt::format("{} is not a parameter: a spectrum is fixed", entry.key)
                       : fmt::format("the study has no number {}", entry.key),
                   "the dotted path of a numeric parameter, such as controller.ki (zerocount parameters)");
      continue;
    }
    const parameters::Parameter& row = plan.table.rows[slots->first];
    if (row.kind != parameters::ParameterKind::real && row.kind != parameters::ParameterKind::whole_number) {
      problems.add(entry.place, field.path, fmt::format("{} is not a number", entry.key),
                   "the dotted path of a numeric parameter (zerocount parameters)");
      continue;
    }
    if (row.name.ends_with(study::suffix_of_rate)) {
      problems.add(entry.place, field.path, "a rate of aging belongs to the machine, and is not tuned",
                   "a parameter of the control or the command");
      continue;
    }
    if (!is_one_number(plan, slots->first)) {
      const bool follows = plan.base[slots->first].kind == study::Value::Kind::derived;
      problems.add(entry.place, field.path,
                   fmt::format("{} {}", entry.key,
                               follows                         ? "follows from measured values"
                               : plan.base[slots->first].aging ? "changes with age"
                                                               : "is swept or drawn at random"),
                   "a parameter with one value, from which tuning starts");
      continue;
    }
    study::FreeParameter parameter{.name = std::string(row.name),
                                   .unit = parameters::unit_of(row, plan.units),
                                   .whole = row.kind == parameters::ParameterKind::whole_number};
    take_range(field, row.range, parameter, problems);
    tuning.free.push_back(parameter);
  }
}

/// Reports parameters that `tune` may change although they have no effect for any values of the free
/// parameters.
void check_effects_of_free(const yaml::Field& map, const study::Tuning& tuning, keys::StudyDraft& draft) {
  const auto is_free = [&](std::string_view name) {
    return std::ranges::find(tuning.free, name, &study::FreeParameter::name) != tuning.free.end();
  };
  for (const rules::EffectRule& rule : rules::effect_rules(draft.plan)) {
    if (rule.warn_only || std::ranges::any_of(rule.depends_on, is_free) ||
        rules::can_have_effect(draft.plan, rule))
      continue;
    for (const yaml::YamlEntry& entry : map.node->entries) {
      if (!is_free(entry.key) || !rules::covers(rule, entry.key)) continue;
      draft.problems.add(entry.place, yaml::entry_of(map, entry).path,
                         parameters::text_on(draft.plan.units.axis, rule.what), rule.expected);
    }
  }
}

}  // namespace

void read_tuning(const yaml::Field& field, keys::StudyDraft& draft) {
  std::optional<study::Tuning>& tuning = draft.study.tuning;
  tuning.emplace();
  shapes::read(field, keys::shape_of("tune"), draft.problems, &draft);
  if (field.node->kind != yaml::YamlNode::Kind::map) return tuning.reset();
  yaml::Problems reported;
  if (const auto free = yaml::find_field(field, "free");
      free && shapes::read(*free, keys::shape_of("tune.free"), reported)) {
    read_free(*free, draft.plan, *tuning, draft.problems);
    check_effects_of_free(*free, *tuning, draft);
  }
  if (draft.study.goals.empty())
    draft.problems.add(field, "without a goal there is nothing to meet",
                       "goal: {band: 1, within: 0.05, moves: 0.99}");
}

}  // namespace zerocount::sections
