#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "experiments/manifest/checks.hpp"
#include "experiments/parameters/measured_parameters.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::manifest {
namespace {

std::vector<std::uint32_t> slots_of(const study::StudyTable& table, std::span<const std::string_view> names) {
  const std::vector<std::size_t> slots = study::slots_named(table, names);
  return {slots.begin(), slots.end()};
}

/// Reports the measured values that are missing at some point.
void require_all(const parameters::MeasuredParameters& group, std::span<const std::uint32_t> slots,
                 const yaml::Place& first, const keys::PlanPlaces& places, keys::Reading& reading) {
  const study::StudyPlan& plan = reading.plan;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (is_given_everywhere(places, plan, slots[i])) continue;
    reading.problems.add_missing(
        first, group.names[i],
        fmt::format("its value in {}, beside the other keys of {}",
                    parameters::unit_of(plan.table.rows[slots[i]], plan.units), group.section));
  }
}

bool is_drawn_per_contact(const study::StudyPlan& plan, std::uint32_t slot) {
  return std::ranges::any_of(study::values_of(plan, slot), [](const study::Value* value) {
    return value->kind == study::Value::Kind::distribution && value->level == study::DrawLevel::contact;
  });
}

/// A contact has one random number for each parameter of the law.
void check_contacts(const parameters::FollowingParameter& parameter, std::span<const std::uint32_t> from,
                    const keys::PlanPlaces& places, keys::Reading& reading) {
  const study::StudyPlan& plan = reading.plan;
  std::vector<std::uint32_t> drawn;
  std::ranges::copy_if(from, std::back_inserter(drawn),
                       [&](std::uint32_t slot) { return is_drawn_per_contact(plan, slot); });
  if (drawn.size() < 2) return;
  reading.problems.add(given_place(places, plan, drawn[1]).value(), plan.table.rows[drawn[1]].name,
                       fmt::format("{} is drawn at each contact too, and {} follows from both",
                                   plan.table.rows[drawn[0]].name, parameter.name),
                       "per: contact at one of them");
}

/// Reports a parameter that is given although it follows from measured ones.
bool check_not_given(const parameters::MeasuredParameters& group, std::uint32_t slot,
                     const keys::PlanPlaces& places, keys::Reading& reading) {
  const auto place = given_place(places, reading.plan, slot);
  if (place)
    reading.problems.add(*place, reading.plan.table.rows[slot].name,
                         fmt::format("it follows from {}, which the manifest gives too", group.section),
                         "one or the other");
  return !place;
}

void let_follow(const parameters::MeasuredParameters& group, const keys::PlanPlaces& places,
                keys::Reading& reading) {
  study::StudyPlan& plan = reading.plan;
  const std::vector<std::uint32_t> measured = slots_of(plan.table, group.names);
  const auto first = std::ranges::find_if(
      measured, [&](std::uint32_t slot) { return given_place(places, plan, slot).has_value(); });
  if (first == measured.end()) return;
  require_all(group, measured, given_place(places, plan, *first).value(), places, reading);
  for (const parameters::FollowingParameter& parameter : group.following) {
    const std::uint32_t slot = slots_of(plan.table, {&parameter.name, 1}).front();
    const std::vector<std::uint32_t> from = slots_of(plan.table, parameter.from);
    if (!check_not_given(group, slot, places, reading)) continue;
    check_contacts(parameter, from, places, reading);
    plan.base[slot] = {.kind = study::Value::Kind::following,
                       .index = static_cast<std::uint32_t>(plan.following.size())};
    plan.following.push_back({from, parameter.value});
  }
}

}  // namespace

void let_follow_from_measured(const keys::PlanPlaces& places, keys::Reading& reading) {
  for (const parameters::MeasuredParameters& group : parameters::measured_parameters())
    let_follow(group, places, reading);
}

void check_what_follows(const keys::PlanPlaces& places, keys::Reading& reading) {
  const study::StudyPlan& plan = reading.plan;
  for (std::size_t slot = 0; slot < plan.base.size(); ++slot) {
    if (plan.base[slot].kind != study::Value::Kind::following) continue;
    const parameters::Parameter& row = plan.table.rows[slot];
    const std::vector<std::uint32_t>& from = plan.following[plan.base[slot].index].from;
    study::visit_points(plan, {&slot, 1}, [&](std::size_t point) {
      const study::ValueLimits limits = study::limits_of_slot(plan, slot, point);
      const numerics::Interval range = parameters::range_of(row, plan.units);
      const bool is_allowed = std::isnan(limits.low) ||  // reported already
                              numerics::contains(range, numerics::closed(limits.low, limits.high));
      if (is_allowed && !std::isinf(limits.high)) return true;
      const std::vector<std::size_t> sources(from.begin(), from.end());
      reading.problems.add(
          place_of_fault(places, plan, sources, point).place, row.name,
          limits.low == limits.high
              ? fmt::format("it is {:.6g} with these measured values", limits.low)
              : fmt::format("it can be {:.6g} to {:.6g} with these measured values", limits.low, limits.high),
          fmt::format("measured values with which it is {}", numerics::range_text(range)));
      return false;
    });
  }
}

}  // namespace zerocount::manifest
