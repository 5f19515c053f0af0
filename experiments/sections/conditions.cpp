#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/sections/sections.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::sections {
namespace {

constexpr OptionWords words{"condition", "a condition cannot override this key"};

/// Index of the option of the axis to which this assignment belongs.
std::size_t option_of(const study::PlanAxis& axis, std::size_t assignment) {
  const auto after = std::ranges::upper_bound(axis.first, static_cast<std::uint32_t>(assignment));
  return static_cast<std::size_t>(after - axis.first.begin()) - 1;
}

/// Reports the first override by a condition that changes a slot (a parameter in the plan) whose value is
/// also given elsewhere.
/// @param what phrase for the message, "is swept"
/// @param other place of the other value
void refuse_override(const SweptAxis& conditions, std::size_t slot, std::string_view what,
                     const yaml::Place& other, keys::StudyDraft& draft) {
  for (std::size_t i = 0; i < conditions.axis.assignments.size(); ++i) {
    if (conditions.axis.assignments[i].slot != slot) continue;
    const std::string_view name = draft.plan.table.rows[slot].name;
    draft.problems.add(
        conditions.places[i],
        fmt::format("conditions.{}.{}", conditions.labels[option_of(conditions.axis, i)], name),
        fmt::format("{} {} at {}: a condition cannot override it", name, what, yaml::place_text(other)),
        "one or the other");
    return;
  }
}

/// Place in the manifest of the first value that the axis assigns to the slot (a parameter in the plan).
yaml::Place place_of(const SweptAxis& axis, std::size_t slot) {
  for (std::size_t i = 0; i < axis.axis.assignments.size(); ++i) {
    if (axis.axis.assignments[i].slot == slot) return axis.places[i];
  }
  return axis.place;
}

void check_not_swept(const SweptAxis& conditions, const std::vector<SweptAxis>& swept,
                     keys::StudyDraft& draft) {
  for (const std::size_t slot : conditions.slots) {
    const auto axis = std::ranges::find_if(swept, [slot](const SweptAxis& one) {
      return std::ranges::find(one.slots, slot) != one.slots.end();
    });
    if (axis != swept.end()) refuse_override(conditions, slot, "is swept", place_of(*axis, slot), draft);
  }
}

/// Sets how often the override is drawn: as often as its parameter. Reports an override that states another
/// level.
void take_level(const yaml::Field& field, std::uint32_t slot, study::Value& value, keys::StudyDraft& draft) {
  using Kind = study::Value::Kind;
  const study::Value& parameter = draft.plan.base[slot];
  if (value.kind != parameter.kind || value.level == parameter.level) return;
  if (value.kind != Kind::distribution && value.kind != Kind::profile) return;
  const auto per =
      field.node->kind == yaml::YamlNode::Kind::map ? yaml::find_field(field, keys::per_key) : std::nullopt;
  if (per) {
    const auto label = [](study::DrawLevel level) {
      return keys::draw_level_labels[static_cast<std::size_t>(level)];
    };
    draft.problems.add(*per,
                       fmt::format("{} is drawn per {}: an override is drawn as often as its parameter",
                                   draft.plan.table.rows[slot].name, label(parameter.level)),
                       fmt::format("per: {}, or the key left out", label(parameter.level)));
    return;
  }
  value.level = parameter.level;
  if (value.kind == Kind::profile) draft.profiles[value.index].level = parameter.level;
}

/// Sets how often the overrides of one condition are drawn: as often as their parameters. The overrides are
/// the assignments from index `first` on, in the order of the condition's map.
void take_levels(const yaml::Field& overrides, std::size_t first, SweptAxis& axis, keys::StudyDraft& draft) {
  for (const yaml::YamlEntry& entry : overrides.node->entries) {
    const auto slots = study::find_slots(entry.key, draft.plan.table);
    if (!slots) continue;
    const yaml::Field field = yaml::entry_of(overrides, entry);
    for (std::size_t i = first; i < axis.axis.assignments.size(); ++i) {
      study::Assignment& one = axis.axis.assignments[i];
      if (one.slot < slots->first || one.slot >= slots->first + slots->count) continue;
      take_level(slots->list ? yaml::item_of(field, one.slot - slots->first) : field, one.slot, one.value,
                 draft);
    }
  }
}

}  // namespace

SweptAxis read_conditions(const yaml::Field& field, const std::vector<SweptAxis>& swept,
                          keys::StudyDraft& draft) {
  SweptAxis axis{.name = "condition", .place = field.node->place};
  if (!shapes::read(field, keys::shape_of("conditions"), draft.problems)) return axis;
  for (const yaml::YamlEntry& entry : field.node->entries) {
    const std::size_t first = axis.axis.assignments.size();
    const std::size_t options = axis.labels.size();
    read_option(field, entry, words, axis, draft);
    if (axis.labels.size() == options) {
      finish_option(axis, entry.key);  // could not be read, which is reported
    } else {
      take_levels(yaml::entry_of(field, entry), first, axis, draft);
    }
  }
  check_not_swept(axis, swept, draft);
  draft.study.settings.conditions = axis.labels;
  return axis;
}

void check_overrides(const yaml::Field& root, const SweptAxis& conditions,
                     const std::vector<yaml::Place>& sampled, keys::StudyDraft& draft) {
  const auto is_overridden = [&](std::size_t slot) {
    return std::ranges::find(conditions.slots, slot) != conditions.slots.end();
  };
  for (std::size_t i = 0; i < draft.plan.sampled_slots.size(); ++i) {
    const std::uint32_t slot = draft.plan.sampled_slots[i];
    if (is_overridden(slot)) refuse_override(conditions, slot, "comes from samples", sampled[i], draft);
  }
  const auto tune = yaml::find_field(root, "tune");
  if (!tune || tune->node->kind != yaml::YamlNode::Kind::map) return;
  const auto free = yaml::find_field(*tune, "free");
  if (!free || free->node->kind != yaml::YamlNode::Kind::map) return;
  for (const yaml::YamlEntry& entry : free->node->entries) {
    const auto slots = study::find_slots(entry.key, draft.plan.table);
    if (slots && is_overridden(slots->first))
      refuse_override(conditions, slots->first, "is tuned", entry.place, draft);
  }
}

}  // namespace zerocount::sections
