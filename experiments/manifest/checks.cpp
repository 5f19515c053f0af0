#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "experiments/manifest/manifest.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/study.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::manifest {
namespace {

constexpr std::size_t max_reported = 20;

// Whether the coarse encoder is used. If not, that of a linear axis has the resolution of the fine one.
bool uses_coarse_encoder(const study::StudyPlan& plan) {
  const auto is_coarse = [](const study::ParameterRange& encoder) {
    return encoder.high == static_cast<double>(loop::EncoderChoice::coarse);
  };
  const auto is_positive = [](const study::ParameterRange& error) { return error.high > 0.0; };
  return study::holds_somewhere(plan, parameter::controller::encoder, is_coarse) ||
         study::holds_somewhere(plan, parameter::controller::coarse::encoder, is_coarse) ||
         study::holds_somewhere(plan, parameter::encoder::coarse_errors::interpolation, is_positive) ||
         study::holds_somewhere(plan, parameter::encoder::coarse_errors::noise, is_positive) ||
         study::holds_somewhere(plan, parameter::encoder::coarse_errors::missed, is_positive);
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
    return !parameters::default_holds(parameter, plan.units) &&
           rules::has_effect(plan, rules, parameter.name);
  }
  // Required values of the command and of elements of lists are checked where these are read.
  if (!parameter.only_on || parameter.element) return false;
  return parameter.name != parameter::encoder::coarse_resolution || uses_coarse_encoder(plan);
}

// Reports missing required parameters: those without a default, and those whose default has other units than
// this study (such as the paper's N m/rad on a linear axis), if they have an effect.
void check_required_values(const keys::PlanPlaces& places, keys::StudyDraft& draft) {
  const study::StudyPlan& plan = draft.plan;
  const std::vector<rules::EffectRule> rules = rules::effect_rules(plan);
  const auto table = parameters::parameter_table();
  for (std::size_t row = 0; row < table.size(); ++row) {
    const parameters::Parameter& parameter = table[row];
    if (!is_required(plan, rules, parameter) || is_given_everywhere(places, plan, row) ||
        plan.base[row].kind == study::Value::Kind::derived)
      continue;
    draft.problems.add_missing(places.base[row], parameter.name, why_required(parameter),
                               fmt::format("its value in {}", parameters::unit_of(parameter, plan.units)));
  }
}

struct Checking {
  const keys::PlanPlaces& places;
  keys::StudyDraft& draft;

  const study::StudyPlan& plan() const { return draft.plan; }
};

void tell(Checking& c, const yaml::Place& place, std::string_view path, const std::string& what,
          std::string_view expected, bool warn_only) {
  const std::string text = parameters::text_on(c.plan().units.axis, what);
  if (warn_only) {
    c.draft.warnings.push_back(yaml::at_place(
        place, path, expected.empty() ? text : fmt::format("{}; expected {}", text, expected)));
  } else {
    c.draft.problems.add(place, path, text, expected);
  }
}

// Place in the sweep that assigns the slot's value at this point, if any.
std::optional<yaml::Place> swept_place(const keys::PlanPlaces& places, const study::StudyPlan& plan,
                                       std::size_t slot, std::size_t point) {
  for (std::size_t a = plan.axes.size(); a-- > 0;) {
    const study::PlanAxis& axis = plan.axes[a];
    const std::size_t option = study::option_at(plan, a, point);
    for (std::size_t i = axis.first[option]; i < axis.first[option + 1]; ++i) {
      if (axis.assignments[i].slot == slot) return places.axes[a][i];
    }
  }
  return std::nullopt;
}

// The values that a fault involves: its values of the list, the parameters of the rule, and other values of
// the list that may cause it.
std::vector<std::size_t> slots_of(const rules::ValueFault& fault, const std::vector<std::size_t>& list,
                                  const std::vector<std::size_t>& involved) {
  std::vector<std::size_t> slots;
  for (const std::size_t i : fault.listed) slots.push_back(list[i]);
  slots.insert(slots.end(), involved.begin(), involved.end());
  return slots;
}

void check_values(Checking& c) {
  using Reports =
      std::set<std::pair<std::size_t, std::string>>;  // the same fault at several points is reported once
  Reports problems;
  Reports warnings;
  for (const rules::ValueRule& rule : rules::value_rules(c.plan())) {
    Reports& reported = rule.warn_only ? warnings : problems;
    const std::vector<std::size_t> named = study::slots_named(c.plan().table, rule.between);
    const std::vector<std::size_t> listed =
        rule.whole_list ? study::slots_of(c.plan().list) : std::vector<std::size_t>{};
    std::vector<std::size_t> involved = named;
    involved.insert(involved.end(), listed.begin(), listed.end());
    study::visit_points(c.plan(), involved, [&](std::size_t point) {
      const std::vector<study::ParameterRange> ranges = study::ranges_at(c.plan(), involved, point);
      const std::span<const study::ParameterRange> all(ranges);
      if (!study::are_readable(all)) return true;  // reported already
      for (const rules::ValueFault& fault :
           rule.find_faults({rule.between, all.first(named.size())}, all.subspan(named.size()))) {
        const std::vector<std::size_t> slots = slots_of(fault, listed, involved);
        if (reported.size() < max_reported && reported.insert({slots.front(), fault.what}).second) {
          const FaultPlace at = place_of_fault(c.places, c.plan(), slots, point);
          const std::string_view name = c.plan().table.rows[rule.once ? at.slot : slots.front()].name;
          tell(c, rule.of_record ? c.places.record : at.place,
               rule.of_record ? rules::record_key(c.plan()) : name, fault.what, fault.expected,
               rule.warn_only);
          if (rule.once) return false;
        }
      }
      return reported.size() < max_reported;
    });
  }
}

bool is_off(const Checking& c, std::size_t slot) {
  const double nothing = c.plan().table.rows[slot].none.value_or(0.0);
  const std::vector<const study::Value*> values = study::values_of(c.plan(), slot);
  return std::all_of(values.begin(), values.end(), [&](const study::Value* value) {
    const study::ParameterRange range = study::range_of(c.plan(), *value);
    return range.low == nothing && range.high == nothing;
  });
}

// The row that stands for the slot in reports: the values of a list are reported once.
std::size_t reported_row(const study::StudyTable& table, std::size_t slot) {
  for (const study::RowGroup& group : table.groups) {
    const bool within = slot >= group.first && slot < group.first + group.count;
    if (within && parameters::is_list(table.rows[group.row])) return group.row;
  }
  return slot;
}

void check_effects(Checking& c) {
  const study::StudyTable& table = c.plan().table;
  std::set<std::size_t> reported_rows;
  for (const rules::EffectRule& rule : rules::effect_rules(c.plan())) {
    std::optional<bool> has_effect;
    for (std::size_t slot = 0; slot < table.rows.size(); ++slot) {
      const auto place =
          rules::covers(rule, table.rows[slot].name) ? given_place(c.places, c.plan(), slot) : std::nullopt;
      if (!place || reported_rows.count(reported_row(table, slot)) > 0 ||
          (rule.off_at_zero && is_off(c, slot)))
        continue;
      if (!has_effect) has_effect = rules::can_have_effect(c.plan(), rule);
      if (*has_effect) continue;
      reported_rows.insert(reported_row(table, slot));
      tell(c, *place, table.rows[slot].name, rule.what, rule.expected, rule.warn_only);
    }
  }
}

/// The given slots (indices of parameters in the plan), each followed by the slots from which its value is
/// computed.
std::vector<std::size_t> with_sources(const study::StudyPlan& plan, std::span<const std::size_t> slots) {
  std::vector<std::size_t> all;
  for (const std::size_t slot : slots) {
    all.push_back(slot);
    if (plan.base[slot].kind != study::Value::Kind::derived) continue;
    const std::vector<std::uint32_t>& from = plan.derived[plan.base[slot].index].from;
    all.insert(all.end(), from.begin(), from.end());
  }
  return all;
}

/// The lowest and the highest value of the slot (one parameter of the plan) at a design point in a setting,
/// at the setting's age. For a profile along the axis these are bounds for all possible rotors, or, if those
/// leave the range of the parameter, bounds of the actual rotors.
std::pair<double, double> aged_extremes(const study::StudyPlan& plan, std::size_t slot, std::size_t point) {
  const study::Value& value = *study::value_at_point(plan, slot, point);
  if (value.kind != study::Value::Kind::profile) return study::extremes_of(plan, slot, point);
  const study::ParameterRange factors = study::age_factors(plan, slot, point);
  const study::Rotors& rotors = *plan.profiles[value.index];
  const auto at_age = [&](const numerics::Interval& values) {
    return std::minmax({values.low * factors.low, values.low * factors.high, values.high * factors.low,
                        values.high * factors.high});
  };
  const auto bounds = at_age(rotors.bounds());
  return numerics::contains(plan.table.rows[slot].range, numerics::closed(bounds.first, bounds.second))
             ? bounds
             : at_age(rotors.all_limits());
}

void check_range_at_ages(const Checking& c, std::size_t slot) {
  const study::StudyPlan& plan = c.plan();
  const parameters::Parameter& parameter = plan.table.rows[slot];
  const numerics::Interval& range = parameter.range;
  study::visit_points(plan, {&slot, 1}, [&](std::size_t point) {
    const study::Value& value = *study::value_at_point(plan, slot, point);
    if (!value.aging || std::isnan(value.number)) return true;
    const auto [low, high] = aged_extremes(plan, slot, point);
    if (std::isnan(low) || (numerics::contains(range, low) && numerics::contains(range, high))) return true;
    c.draft.problems.add(
        place_of_fault(c.places, plan, {&slot, 1}, point).place, parameter.name,
        fmt::format("its values at {}, {:.6g} to {:.6g}, leave the allowed range {}",
                    study::age_text(c.draft.study.settings.ages, study::age_at(plan, point)), low, high,
                    numerics::notation(range)),
        fmt::format("a rate of aging with which all values are {}", numerics::range_text(range)));
    return false;
  });
}

}  // namespace

void check_ages(const keys::PlanPlaces& places, keys::StudyDraft& draft) {
  const study::StudyPlan& plan = draft.plan;
  if (plan.ages.empty()) return;
  const Checking checking{places, draft};
  for (std::size_t slot = 0; slot < plan.base.size(); ++slot) {
    if (plan.base[slot].kind != study::Value::Kind::derived && study::changes_with_age(plan, slot))
      check_range_at_ages(checking, slot);
  }
}

bool is_given_everywhere(const keys::PlanPlaces& places, const study::StudyPlan& plan, std::size_t slot) {
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

std::optional<yaml::Place> given_place(const keys::PlanPlaces& places, const study::StudyPlan& plan,
                                       std::size_t slot) {
  if (places.written[slot]) return places.base[slot];
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    const std::vector<study::Assignment>& assignments = plan.axes[a].assignments;
    const auto found =
        std::find_if(assignments.begin(), assignments.end(),
                     [&](const study::Assignment& assignment) { return assignment.slot == slot; });
    if (found != assignments.end())
      return places.axes[a][static_cast<std::size_t>(found - assignments.begin())];
  }
  return std::nullopt;
}

FaultPlace place_of_fault(const keys::PlanPlaces& places, const study::StudyPlan& plan,
                          std::span<const std::size_t> involved, std::size_t point) {
  const std::vector<std::size_t> slots = with_sources(plan, involved);
  for (const std::size_t slot : slots) {
    if (const auto place = swept_place(places, plan, slot, point)) return {*place, slot};
  }
  for (const std::size_t slot : slots) {
    if (places.written[slot]) return {places.base[slot], slot};
  }
  return {places.base[slots.front()], slots.front()};
}

void check_points(const keys::PlanPlaces& places, keys::StudyDraft& draft) {
  Checking checking{places, draft};
  check_required_values(places, draft);
  check_values(checking);
  check_effects(checking);
}

}  // namespace zerocount::manifest
