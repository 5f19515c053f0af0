#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "experiments/sections/sections.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::sections {
namespace {

/// Reads the value of `field` and assigns it to the slot (a parameter in the plan) in the current option of
/// the axis. If the value changes with age, its rate is assigned before it.
void assign_read(SweptAxis& axis, std::size_t slot, const yaml::Field& field, keys::StudyDraft& draft) {
  const study::Value value = keys::read_value(field, slot, draft);
  if (draft.rate) {
    note_slots(axis, {draft.rate->slot, 1, false});
    assign(axis, draft.rate->slot, draft.rate->value, field.node->place);
  }
  assign(axis, slot, value, field.node->place);
}

}  // namespace

void read_assignments(const yaml::Field& field, const study::SlotRange& slots, SweptAxis& axis,
                      keys::StudyDraft& draft) {
  if (!slots.list) {
    assign_read(axis, slots.first, field, draft);
    return;
  }
  const std::string_view noun = noun_of(slots, draft.plan.table);
  const std::string expected = fmt::format("a list of {} {}, as at every point", slots.count, noun);
  if (!yaml::check_list(field, expected, draft.problems)) return;
  const std::size_t count = field.node->items.size();
  if (count != slots.count) {
    draft.problems.add(field, fmt::format("found a list of {} {}", count, noun), expected);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const yaml::Field item = yaml::item_of(field, i);
    assign_read(axis, slots.first + i, item, draft);
  }
}

void inherit_aging(study::PlanAxis& axis, const study::StudyPlan& plan) {
  for (study::Assignment& one : axis.assignments) {
    if (!one.value.aging) one.value.aging = plan.base[one.slot].aging;
  }
}

void note_slots(SweptAxis& axis, const study::SlotRange& slots) {
  for (std::size_t slot = slots.first; slot < slots.first + slots.count; ++slot) {
    if (std::find(axis.slots.begin(), axis.slots.end(), slot) == axis.slots.end()) axis.slots.push_back(slot);
  }
}

void read_option(const yaml::Field& options, const yaml::YamlEntry& entry, const OptionWords& words,
                 SweptAxis& axis, keys::StudyDraft& draft) {
  const yaml::Field field = yaml::entry_of(options, entry);
  if (entry.key.find_first_not_of(" \t\r\n") == std::string::npos) {
    draft.problems.add(entry.place, field.path, fmt::format("the name of the {} is empty", words.option),
                       "a name");
  }
  if (!yaml::check_map(field, "a map from dotted paths to values", draft.problems)) return;
  std::set<std::size_t> in_this_option;
  for (const yaml::YamlEntry& assignment : field.node->entries) {
    const auto slots = find_assigned(field, assignment, words.refusal, draft);
    if (!slots) continue;
    note_slots(axis, *slots);
    const std::size_t first = axis.axis.assignments.size();
    read_assignments(yaml::entry_of(field, assignment), *slots, axis, draft);
    // Those of the rates of aging too.
    for (std::size_t i = first; i < axis.axis.assignments.size(); ++i) {
      const std::size_t slot = axis.axis.assignments[i].slot;
      if (in_this_option.insert(slot).second) continue;
      draft.problems.add(
          assignment.place, yaml::entry_of(field, assignment).path,
          fmt::format("{} is given twice in this {}", draft.plan.table.rows[slot].name, words.option),
          "one value");
      break;
    }
  }
  finish_option(axis, entry.key);
}

}  // namespace zerocount::sections
