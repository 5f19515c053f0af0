#include "experiments/manifest/checks.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "experiments/manifest/manifest_keys.hpp"
#include "experiments/manifest/required_values.hpp"
#include "experiments/rules/effect_rules.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/slots.hpp"

namespace zerocount {
namespace {

constexpr std::size_t max_reported = 20;

struct Checking {
  const PlanPlaces& places;
  Reading& reading;

  const StudyPlan& plan() const { return reading.plan; }
};

void tell(Checking& c, const Place& place, std::size_t slot, const std::string& what,
          std::string_view expected, bool warn_only) {
  const std::string path = slot_name(slot, c.plan().list);
  if (warn_only) {
    c.reading.warnings.push_back(at_place(place, path, what));
  } else {
    c.reading.problems.add(place, path, what, expected);
  }
}

// Where an axis gives the slot its value at this point.
std::optional<Place> swept_place(const Checking& c, std::size_t slot, std::size_t point) {
  for (std::size_t a = c.plan().axes.size(); a-- > 0;) {
    const PlanAxis& axis = c.plan().axes[a];
    const std::size_t option = option_at(c.plan(), a, point);
    for (std::size_t i = axis.first[option]; i < axis.first[option + 1]; ++i) {
      if (axis.assignments[i].slot == slot) return c.places.axes[a][i];
    }
  }
  return std::nullopt;
}

// Of the values that a fault is between: that of the sweep, else one that is written in the manifest, else
// the first.
Place place_of_fault(const Checking& c, const std::vector<std::size_t>& slots, std::size_t point) {
  for (const std::size_t slot : slots) {
    if (const auto place = swept_place(c, slot, point)) return *place;
  }
  for (const std::size_t slot : slots) {
    if (c.places.written[slot]) return c.places.base[slot];
  }
  return c.places.base[slots.front()];
}

// The values that a fault is between: those of the list that it names, the parameters of the rule, and what
// else of the list it may come from.
std::vector<std::size_t> slots_of(const ValueFault& fault, const std::vector<std::size_t>& involved) {
  std::vector<std::size_t> slots;
  for (const std::size_t i : fault.listed) slots.push_back(listed_slot(i));
  slots.insert(slots.end(), involved.begin(), involved.end());
  return slots;
}

void check_values(Checking& c) {
  using Told = std::set<std::pair<std::size_t, std::string>>;  // the same fault at many points is one
  Told problems;
  Told warnings;
  for (const ValueRule& rule : value_rules(c.plan())) {
    Told& reported = rule.warn_only ? warnings : problems;
    const std::vector<std::size_t> named = slots_named(rule.between);
    const std::vector<std::size_t> listed =
        rule.whole_list ? listed_slots(c.plan().list) : std::vector<std::size_t>{};
    std::vector<std::size_t> involved = named;
    involved.insert(involved.end(), listed.begin(), listed.end());
    visit_points(c.plan(), involved, [&](std::size_t point) {
      const std::vector<ValueLimits> limits = limits_at(c.plan(), involved, point);
      const std::span<const ValueLimits> all(limits);
      if (!are_readable(all)) return true;  // told already
      for (const ValueFault& fault : rule.find_faults(all.first(named.size()), all.subspan(named.size()))) {
        const std::vector<std::size_t> slots = slots_of(fault, involved);
        if (reported.size() < max_reported && reported.insert({slots.front(), fault.what}).second) {
          tell(c, place_of_fault(c, slots, point), slots.front(), fault.what, fault.expected, rule.warn_only);
        }
      }
      return reported.size() < max_reported;
    });
  }
}

// Where the manifest gives the parameter a value: outside the sweep, or first in it.
std::optional<Place> given_place(const Checking& c, std::size_t row) {
  if (c.places.written[row]) return c.places.base[row];
  for (std::size_t a = 0; a < c.plan().axes.size(); ++a) {
    const std::vector<Assignment>& assignments = c.plan().axes[a].assignments;
    const auto found = std::find_if(assignments.begin(), assignments.end(),
                                    [&](const Assignment& assignment) { return assignment.slot == row; });
    if (found != assignments.end())
      return c.places.axes[a][static_cast<std::size_t>(found - assignments.begin())];
  }
  return std::nullopt;
}

bool asks_for_nothing(const Checking& c, std::size_t row) {
  const std::string_view name = parameter_table()[row].name;
  return !holds_somewhere(c.plan(), {&name, 1}, [](std::span<const ValueLimits> limits) {
    return limits[0].low != 0.0 || limits[0].high != 0.0;
  });
}

void check_effects(Checking& c) {
  const auto table = parameter_table();
  std::set<std::size_t> told;
  for (const EffectRule& rule : effect_rules(c.plan())) {
    std::optional<bool> has_effect;
    for (std::size_t row = 0; row < table.size(); ++row) {
      const bool covered = std::any_of(rule.keys.begin(), rule.keys.end(),
                                       [&](std::string_view key) { return is_within(table[row].name, key); });
      const auto place = covered ? given_place(c, row) : std::nullopt;
      if (!place || told.count(row) > 0 || (rule.off_at_zero && asks_for_nothing(c, row))) continue;
      if (!has_effect) has_effect = can_have_effect(c.plan(), rule);
      if (*has_effect) continue;
      told.insert(row);
      tell(c, *place, row, text_on(c.plan().units.axis, rule.what), rule.expected, rule.warn_only);
    }
  }
}

}  // namespace

void check_points(const PlanPlaces& places, Reading& reading) {
  Checking checking{places, reading};
  check_required_values(places, reading);
  check_values(checking);
  check_effects(checking);
}

}  // namespace zerocount
