#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/text/text.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/parameters/unknown_key.hpp"
#include "experiments/sections/sections.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::sections {
namespace {

constexpr std::string_view refusal_of_sweep = "this key cannot be swept";

// State of the reading of the axes: the slots in use and the number of points so far.
struct SweepState {
  keys::StudyDraft& draft;
  std::size_t points{1};
  bool too_many{false};
  std::set<std::size_t> in_grid{};   // slots of the grid's axes so far
  std::set<std::size_t> in_cases{};  // slots of the cases

  const study::StudyTable& table() const { return draft.plan.table; }
};

// Multiplies the number of points by `options`; false, after a report, if there are too many.
bool check_point_count(const yaml::Field& sweep, std::size_t options, SweepState& state) {
  const bool fits = !state.too_many && (options == 0 || state.points <= max_points / options);
  if (fits) {
    state.points *= std::max<std::size_t>(options, 1);
  } else if (!state.too_many) {
    state.too_many = true;
    state.draft.problems.add(sweep.node->place, "sweep", "the sweep has too many design points",
                             fmt::format("at most {} points", max_points));
  }
  return fits;
}

// The value in an option's label: a number in its shortest form, anything else as in the manifest.
std::string value_label(const SweptAxis& axis, const study::SlotRange& slots, const yaml::YamlNode& node,
                        const study::StudyTable& table) {
  if (slots.list || node.kind == yaml::YamlNode::Kind::map ||
      parameters::has_labels(table.rows[slots.first]) || axis.axis.assignments.empty() ||
      axis.axis.assignments.back().value.kind != study::Value::Kind::number) {
    return yaml::flow_text(node);
  }
  return parameters::number_text(table.rows[slots.first], axis.axis.assignments.back().value.number);
}

void read_listed(const yaml::Field& field, const study::SlotRange& slots, SweptAxis& axis,
                 SweepState& state) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < field.node->items.size(); ++i) {
    const yaml::Field item = yaml::item_of(field, i);
    const std::size_t problems_before = state.draft.problems.size();
    read_assignments(item, slots, axis, state.draft);
    if (state.draft.problems.size() > problems_before) continue;  // an unreadable value equals no other
    std::string label = fmt::format("{}={}", axis.name, value_label(axis, slots, *item.node, state.table()));
    if (!seen.insert(label).second) {
      state.draft.problems.add(
          item, fmt::format("duplicate value {}", yaml::in_quotes(yaml::flow_text(*item.node))),
          "different values");
    }
    finish_option(axis, std::move(label));
  }
}

void read_spaced(const yaml::Field& sweep, const yaml::Field& field, const study::SlotRange& slots,
                 SweptAxis& axis, SweepState& state) {
  const auto& entries = field.node->entries;
  const bool known = entries.size() == 1 && (entries[0].key == "linspace" || entries[0].key == "logspace");
  if (!known || slots.list) {
    yaml::add_wrong_type(
        field,
        slots.list
            ? fmt::format("a list of lists of {}", noun_of(slots, state.table()))
            : "a list of values, {linspace: [first, last, number]} or {logspace: [first, last, number]}",
        state.draft.problems);
    return;
  }
  const yaml::Field inner = yaml::entry_of(field, entries[0]);
  const auto spacing = read_spacing(inner, entries[0].key == "logspace", state.draft.problems);
  if (!spacing || !check_point_count(sweep, spacing->count, state)) return;
  const std::vector<double> values = spaced_values(*spacing);
  std::vector<std::string> labels = spaced_labels(axis.name, values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const study::Value value = keys::checked_number(inner, slots.first, values[i], state.draft);
    assign(axis, slots.first, value, inner.node->place);
    finish_option(axis, std::move(labels[i]));
    if (std::isnan(value.number)) return;  // one report is enough
  }
}

// Reports a parameter in two axes of the grid. If the cases also give it a value, the grid takes precedence,
// with a warning.
// @param slots of the axis
bool take_for_grid(const yaml::Field& grid, const yaml::YamlEntry& entry, std::span<const std::size_t> slots,
                   SweepState& state) {
  const std::string path = yaml::entry_of(grid, entry).path;
  for (const std::size_t slot : slots) {
    if (!state.in_grid.insert(slot).second) {
      state.draft.problems.add(entry.place, path,
                               fmt::format("{} is swept twice", state.table().rows[slot].name),
                               "each parameter in one axis of the grid");
      return false;
    }
    if (state.in_cases.count(slot) > 0) {
      state.draft.warnings.push_back(
          yaml::at_place(entry.place, path,
                         fmt::format("the values of the grid replace those of the cases for {}",
                                     state.table().rows[slot].name)));
    }
  }
  return true;
}

void read_grid(const yaml::Field& sweep, const yaml::Field& grid, std::vector<SweptAxis>& axes,
               SweepState& state) {
  if (!yaml::check_map(grid, "a map from dotted paths to lists of values", state.draft.problems)) return;
  for (const yaml::YamlEntry& entry : grid.node->entries) {
    const auto slots = find_assigned(grid, entry, refusal_of_sweep, state.draft);
    if (!slots) continue;
    const yaml::Field field = yaml::entry_of(grid, entry);
    SweptAxis axis{.name = entry.key, .place = field.node->place};
    note_slots(axis, *slots);
    if (!take_for_grid(grid, entry, axis.slots, state)) continue;
    const std::size_t slot_count = axis.slots.size();
    if (field.node->kind == yaml::YamlNode::Kind::map) {
      read_spaced(sweep, field, *slots, axis, state);
    } else if (yaml::check_list(field, "a list of values, such as [1, 2]", state.draft.problems)) {
      if (field.node->items.empty()) {
        state.draft.problems.add(field, "the list is empty", "at least one value");
      } else if (check_point_count(sweep, field.node->items.size(), state)) {
        read_listed(field, *slots, axis, state);
      }
    }
    take_for_grid(grid, entry, std::span(axis.slots).subspan(slot_count), state);  // rates of aging
    axes.push_back(std::move(axis));
  }
}

/// Reports a case whose name would be taken for the number of a design point on the command line.
void check_case_name(const yaml::Field& cases, const yaml::YamlEntry& entry, yaml::Problems& problems) {
  if (!text::parse_number<std::int64_t>(entry.key)) return;
  problems.add(entry.place, yaml::entry_of(cases, entry).path,
               "the name of a case is a whole number, which stands for the number of a design point",
               fmt::format("a name such as 'case {}'", entry.key));
}

void read_cases(const yaml::Field& sweep, const yaml::Field& cases, std::vector<SweptAxis>& axes,
                SweepState& state) {
  if (!yaml::check_map(cases, "a map from names to cases", state.draft.problems)) return;
  const auto& entries = cases.node->entries;
  if (entries.empty() || !check_point_count(sweep, entries.size(), state)) return;
  SweptAxis axis{.cases = true, .name = "case", .place = cases.node->place};
  for (const yaml::YamlEntry& entry : entries) {
    check_case_name(cases, entry, state.draft.problems);
    read_option(cases, entry, OptionWords{"case", refusal_of_sweep}, axis, state.draft);
  }
  state.in_cases.insert(axis.slots.begin(), axis.slots.end());
  axes.push_back(std::move(axis));
}

// Reports keys other than grid and cases.
void check_parts(const yaml::Field& sweep, keys::StudyDraft& draft) {
  const std::vector<std::string> parts{"grid", "cases"};
  for (const yaml::YamlEntry& entry : sweep.node->entries) {
    if (std::find(parts.begin(), parts.end(), entry.key) != parts.end()) continue;
    if (study::find_slots(entry.key, draft.plan.table)) {
      draft.problems.add(entry.place, yaml::entry_of(sweep, entry).path,
                         "a swept parameter stands in the grid or in a case",
                         fmt::format("sweep: {{grid: {{{}: [...]}}}}", entry.key));
    } else {
      parameters::add_unknown_key(sweep, entry, parts, draft.problems);
    }
  }
}

}  // namespace

std::vector<SweptAxis> read_sweep(const yaml::Field& sweep, keys::StudyDraft& draft) {
  std::vector<SweptAxis> axes;
  if (!yaml::check_map(sweep, "a map with grid, cases or both", draft.problems)) return axes;
  check_parts(sweep, draft);
  SweepState state{.draft = draft};
  if (const auto cases = yaml::find_field(sweep, "cases")) read_cases(sweep, *cases, axes, state);
  if (const auto grid = yaml::find_field(sweep, "grid")) read_grid(sweep, *grid, axes, state);
  return axes;
}

}  // namespace zerocount::sections
