#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/manifest/manifest.hpp"
#include "experiments/parameters/measured_parameters.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/measured_machines.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::manifest {
namespace {

using parameters::MeasuredParameters;

std::vector<std::uint32_t> slots_of(const study::StudyTable& table, std::span<const std::string_view> names) {
  const std::vector<std::size_t> slots = study::slots_named(table, names);
  return {slots.begin(), slots.end()};
}

/// The slot (index in the plan) of the first of these parameters that the manifest gives; empty if it gives
/// none.
std::optional<std::uint32_t> first_given(std::span<const std::string_view> names,
                                         const keys::PlanPlaces& places, const study::StudyPlan& plan) {
  for (const std::uint32_t slot : slots_of(plan.table, names))
    if (given_place(places, plan, slot)) return slot;
  return std::nullopt;
}

std::optional<std::uint32_t> first_own_given(const MeasuredParameters& group, const keys::PlanPlaces& places,
                                             const study::StudyPlan& plan) {
  return first_given(std::span(group.names).first(group.own), places, plan);
}

/// The other group of measured parameters in the same section of the manifest; null if there is none.
const MeasuredParameters* alternative_to(const MeasuredParameters& group) {
  const auto all = parameters::measured_parameters();
  const auto other = std::ranges::find_if(
      all, [&](const MeasuredParameters& one) { return one.section == group.section && &one != &group; });
  return other == all.end() ? nullptr : &*other;
}

/// Whether the manifest uses this group of measured parameters. Keys that two groups share count for the
/// first group, and a manifest that gives both groups uses the first.
bool is_chosen(const MeasuredParameters& group, const keys::PlanPlaces& places,
               const study::StudyPlan& plan) {
  const MeasuredParameters* const other = alternative_to(group);
  const bool is_first = other == nullptr || &group < other;
  const bool gives_other = other != nullptr && first_own_given(*other, places, plan);
  if (first_own_given(group, places, plan)) return is_first || !gives_other;
  return is_first && !gives_other && first_given(group.names, places, plan);
}

/// Reports the measured parameters of a group that the manifest does not give at some design point.
void require_all(const study::MeasuredSlots& measured, const yaml::Place& first,
                 const keys::PlanPlaces& places, keys::StudyDraft& draft) {
  const study::StudyPlan& plan = draft.plan;
  const MeasuredParameters* const other = alternative_to(*measured.group);
  for (std::size_t i = 0; i < measured.slots.size(); ++i) {
    if (is_given_everywhere(places, plan, measured.slots[i])) continue;
    const bool has_other = other != nullptr && i < measured.group->own;
    draft.problems.add_missing(
        first, measured.group->names[i],
        fmt::format("its value in {}, beside the other keys of {}{}",
                    parameters::unit_of(plan.table.rows[measured.slots[i]], plan.units),
                    measured.group->section, has_other ? fmt::format(", or {}", other->names.front()) : ""));
  }
}

/// Whether the parameter of the slot is absent from the manifest. It must be, because it follows from
/// measured parameters; a parameter that is given nevertheless is reported.
bool check_not_given(const MeasuredParameters& group, std::uint32_t slot, const keys::PlanPlaces& places,
                     keys::StudyDraft& draft) {
  const auto place = given_place(places, draft.plan, slot);
  if (place)
    draft.problems.add(*place, draft.plan.table.rows[slot].name,
                       fmt::format("it follows from {}, which the manifest gives too", group.section),
                       "one or the other");
  return !place;
}

/// Whether the manifest gives no key of another group of measured parameters that determines the same
/// parameters. Such keys are reported.
bool check_alone(const MeasuredParameters& group, const keys::PlanPlaces& places, keys::StudyDraft& draft) {
  const study::StudyPlan& plan = draft.plan;
  const MeasuredParameters* const other = alternative_to(group);
  const auto own_of_other = other == nullptr ? std::nullopt : first_own_given(*other, places, plan);
  if (!own_of_other) return true;
  draft.problems.add(given_place(places, plan, *own_of_other).value(), plan.table.rows[*own_of_other].name,
                     fmt::format("the manifest gives {} too", group.names.front()), "one or the other");
  return false;
}

void let_follow(const MeasuredParameters& group, const keys::PlanPlaces& places, keys::StudyDraft& draft) {
  study::StudyPlan& plan = draft.plan;
  const study::MeasuredSlots measured{&group, slots_of(plan.table, group.names)};
  const std::uint32_t first = first_given(group.names, places, plan).value();
  if (check_alone(group, places, draft))
    require_all(measured, given_place(places, plan, first).value(), places, draft);
  plan.measured.push_back(measured);
  for (const parameters::DerivedParameter& parameter : group.derived) {
    const std::uint32_t slot = slots_of(plan.table, {&parameter.name, 1}).front();
    if (!check_not_given(group, slot, places, draft)) continue;
    plan.base[slot] = {.kind = study::Value::Kind::derived,
                       .index = static_cast<std::uint32_t>(plan.derived.size())};
    plan.derived.push_back({slots_of(plan.table, parameter.from), parameter.value});
  }
}

/// The measured values (such as stiffnesses) of one group, as they are drawn for each trial, machine or world
/// of a study.
class MeasuredDraws {
 public:
  MeasuredDraws(const study::Study& study, const study::MeasuredSlots& measured)
      : study_(study), plan_(*study.plan), measured_(measured) {}

  /// Whether no possible draw at a design point in a setting can be contradictory, so that single draws need
  /// no check.
  bool are_safe(std::size_t point) const {
    return !study::fault_of_machine(plan_, point, measured_, [&](std::uint32_t slot) {
      return free_ends(slot).value_or(study::extremes_of(plan_, slot, point));
    });
  }

  /// The contradiction in the measured values of a draw; empty if there is none.
  /// @param draw index of the draw in the setting of this point of the plan
  std::optional<study::MeasuredFault> fault_of(std::size_t point, std::int64_t draw) const {
    const std::int64_t trial = study::trial_indices(study_).trial_of(draw, study::setting_at(plan_, point));
    const std::vector<double> numbers =
        study::drawn_numbers(study_, study::design_point(plan_, point), trial, measured_.slots);
    return study::fault_of_machine(plan_, point, measured_, [&](std::uint32_t slot) {
      const auto i = std::ranges::find(measured_.slots, slot) - measured_.slots.begin();
      const double number = numbers[static_cast<std::size_t>(i)];
      return free_ends(slot).value_or(std::pair(number, number));
    });
  }

  /// How often the measured values of a design point are drawn: the most frequent level among them (study,
  /// world, machine, trial), apart from values drawn anew at each contact.
  study::DrawLevel level_at(std::size_t point) const {
    study::DrawLevel level = study::DrawLevel::study;
    for (const std::uint32_t slot : measured_.slots) {
      const study::Value& value = *study::value_at_point(plan_, slot, point);
      if (value.kind == study::Value::Kind::distribution && !study::is_drawn_per_contact(value))
        level = std::max(level, value.level);
    }
    return level;
  }

  /// The number of different draws of the measured values at a design point in a setting. These are the draws
  /// with the lowest indices.
  std::int64_t count_at(std::size_t point) const { return study::draw_count(study_, level_at(point)); }

 private:
  /// The range that the section `tune` gives a parameter; empty if it does not free the parameter.
  std::optional<std::pair<double, double>> free_ends(std::uint32_t slot) const {
    if (!study_.tuning) return std::nullopt;
    const auto free =
        std::ranges::find(study_.tuning->free, plan_.table.rows[slot].name, &study::FreeParameter::name);
    return free == study_.tuning->free.end() ? std::nullopt : std::optional(std::pair(free->low, free->high));
  }

  const study::Study& study_;
  const study::StudyPlan& plan_;
  const study::MeasuredSlots& measured_;
};

std::string_view name_of(study::DrawLevel level) {
  if (level == study::DrawLevel::machine) return "machine";
  return keys::draw_level_labels[static_cast<std::size_t>(level)];
}

/// Reports the first draw of measured values at the point that no machine can have, and the number of such
/// draws. Returns whether there is no such draw.
bool check_draws(const MeasuredDraws& draws, std::size_t point, const study::Study& study,
                 const keys::PlanPlaces& places, keys::StudyDraft& draft) {
  const std::int64_t count = draws.count_at(point);
  std::optional<study::MeasuredFault> first;
  std::int64_t first_index = 0;
  std::int64_t faulty = 0;
  for (std::int64_t index = 0; index < count; ++index) {
    auto fault = draws.fault_of(point, index);
    if (fault && faulty++ == 0) {
      first = std::move(fault);
      first_index = index;
    }
  }
  if (!first) return true;
  const auto design = static_cast<std::size_t>(study::design_point(*study.plan, point));
  const std::string_view unit = name_of(draws.level_at(point));
  const std::string of = count == 1 ? "" : fmt::format("{} {}: ", unit, first_index);
  const std::string how_many = faulty > 1 ? fmt::format(" ({} of {} {}s)", faulty, count, unit) : "";
  const std::string at = study::point_count(study) == 1
                             ? ""
                             : fmt::format(" at point {} ({})", design, study.points.labels[design]);
  const std::string under = study::setting_phrase(study.settings, study::setting_at(*study.plan, point));
  const std::vector<std::size_t> slots(first->slots.begin(), first->slots.end());
  const FaultPlace place = place_of_fault(places, *study.plan, slots, point);
  draft.problems.add(place.place, study.plan->table.rows[place.slot].name,
                     fmt::format("{}{}{}{}{}", of, first->what, at, under, how_many), first->expected);
  return false;
}

}  // namespace

void let_follow_from_measured(const keys::PlanPlaces& places, keys::StudyDraft& draft) {
  for (const MeasuredParameters& group : parameters::measured_parameters()) {
    if (is_chosen(group, places, draft.plan)) let_follow(group, places, draft);
  }
}

void check_what_follows(const keys::PlanPlaces& places, keys::StudyDraft& draft) {
  const study::StudyPlan& plan = draft.plan;
  for (std::size_t slot = 0; slot < plan.base.size(); ++slot) {
    if (plan.base[slot].kind != study::Value::Kind::derived) continue;
    const parameters::Parameter& row = plan.table.rows[slot];
    const study::DerivedValue& derived = plan.derived[plan.base[slot].index];
    if (derived.value == nullptr) continue;  // it has the range of its source
    study::visit_points(plan, {&slot, 1}, [&](std::size_t point) {
      const study::ParameterRange limits = study::range_of_slot(plan, slot, point);
      const numerics::Interval& range = row.range;
      const bool is_allowed = std::isnan(limits.low) ||  // reported already, or by check_measured_machines()
                              numerics::contains(range, numerics::closed(limits.low, limits.high));
      if (is_allowed && !std::isinf(limits.high)) return true;
      const std::vector<std::size_t> sources(derived.from.begin(), derived.from.end());
      draft.problems.add(
          place_of_fault(places, plan, sources, point).place, row.name,
          limits.low == limits.high
              ? fmt::format("it is {:.6g} with these measured values", limits.low)
              : fmt::format("it can be {:.6g} to {:.6g} with these measured values", limits.low, limits.high),
          fmt::format("measured values with which it is {}", numerics::range_text(range)));
      return false;
    });
  }
}

void check_measured_machines(const study::Study& study, const keys::PlanPlaces& places,
                             keys::StudyDraft& draft) {
  constexpr std::size_t max_reported = 20;
  std::size_t reported = 0;
  for (const study::MeasuredSlots& measured : study.plan->measured) {
    const MeasuredDraws draws(study, measured);
    const auto check = [&](std::size_t point) {
      if (draws.are_safe(point)) return true;
      if (!check_draws(draws, point, study, places, draft)) ++reported;
      return reported < max_reported;
    };
    const std::vector<std::size_t> slots(measured.slots.begin(), measured.slots.end());
    if (!study.independent_points) {
      study::visit_points(*study.plan, slots, check);
      continue;
    }
    const std::size_t points = study::plan_point(*study.plan, study::point_count(study));
    for (std::size_t point = 0; point < points && check(point); ++point) {
    }
  }
}

}  // namespace zerocount::manifest
