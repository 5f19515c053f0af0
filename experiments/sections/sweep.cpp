#include "experiments/sections/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/parameters/unknown_key.hpp"
#include "experiments/sections/spacing.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::sections {
namespace {

// State of the reading of the axes: the slots in use and the number of points so far.
struct SweepReading {
  keys::Reading& reading;
  std::size_t points{1};
  bool too_many{false};
  std::set<std::size_t> in_grid{};   // slots of the grid's axes so far
  std::set<std::size_t> in_cases{};  // slots of the cases

  const study::StudyTable& table() const { return reading.plan.table; }
};

// The names of the rows, of long lists only the first ones.
std::vector<std::string> swept_names(const study::StudyTable& table) {
  constexpr std::size_t max_of_studies = 100;
  const std::size_t count =
      std::min(table.rows.size(), parameters::parameter_table().size() + max_of_studies);
  std::vector<std::string> names;
  for (std::size_t row = 0; row < count; ++row) names.emplace_back(table.rows[row].name);
  return names;
}

// Multiplies the number of points by `options`; false, after a report, if there are too many.
bool check_point_count(const yaml::Field& sweep, std::size_t options, SweepReading& state) {
  const bool fits = !state.too_many && (options == 0 || state.points <= max_points / options);
  if (fits) {
    state.points *= std::max<std::size_t>(options, 1);
  } else if (!state.too_many) {
    state.too_many = true;
    state.reading.problems.add(sweep.node->place, "sweep", "the sweep has too many design points",
                               fmt::format("at most {} points", max_points));
  }
  return fits;
}

// The names of the values of the list of elements or coefficients to which an unknown path leads.
std::string names_like(const study::StudyTable& table, std::string_view pattern) {
  std::vector<std::string_view> names;
  for (const parameters::Parameter& row : table.rows) {
    const std::string known = parameters::without_indices(row.name);
    if (parameters::has_value(row) && known != row.name &&
        keys::is_within(pattern, known.substr(0, known.find(".#"))))
      names.push_back(row.name);
  }
  return names.empty() ? "" : fmt::format("one of {}", fmt::join(names, ", "));
}

std::optional<study::SlotRange> find_swept(const yaml::Field& map, const yaml::YamlEntry& entry,
                                           SweepReading& state) {
  const study::StudyTable& table = state.table();
  if (auto slots = study::find_slots(entry.key, table)) return slots;
  // The parameters of a plugin that could not be loaded, which is reported, are not known.
  if (state.reading.plugin_failed && keys::is_within(entry.key, "controller.parameters")) return std::nullopt;
  yaml::Problems& problems = state.reading.problems;
  const std::string path = yaml::entry_of(map, entry).path;
  const std::string pattern = parameters::without_indices(entry.key);
  const bool of_element = parameters::find_element_list(pattern.substr(0, pattern.find(".#"))) != nullptr;
  if (of_element && pattern != entry.key) {
    const std::string known = names_like(table, pattern);
    problems.add(entry.place, path, fmt::format("the study has no {}", entry.key),
                 known.empty() ? "the list in its section of the manifest" : known);
  } else if (const auto row = study::find_list_row(entry.key)) {
    const parameters::Parameter& list = table.rows[*row];
    if (const auto values = study::find_list(table, *row)) {
      problems.add(entry.place, path, fmt::format("the study has no {} with this index", list.list->singular),
                   fmt::format("an index from 0 to {}", values->count - 1));
    } else {
      problems.add(entry.place, path, fmt::format("the study has no {}", list.name),
                   keys::is_within(list.name, keys::required_section)
                       ? fmt::format("{}, which it has", table.rows[state.reading.plan.list.row].name)
                       : "the list in its section of the manifest");
    }
  } else if (keys::find_general_key(entry.key) != nullptr) {
    problems.add(entry.place, path, "this key cannot be swept",
                 "a dotted path of the table of parameters, such as controller.ki");
  } else {
    parameters::add_unknown_key(map, entry, swept_names(table), problems);
  }
  return std::nullopt;
}

void assign(SweptAxis& axis, std::size_t slot, const study::Value& value, const yaml::Place& place) {
  axis.axis.assignments.push_back({static_cast<std::uint32_t>(slot), value});
  axis.places.push_back(place);
}

void finish_option(SweptAxis& axis, std::string label) {
  axis.axis.first.push_back(static_cast<std::uint32_t>(axis.axis.assignments.size()));
  axis.labels.push_back(std::move(label));
}

// Noun for the values of a list.
std::string_view noun_of(const study::SlotRange& list, const SweepReading& state) {
  for (const study::RowGroup& group : state.table().groups) {
    const parameters::Parameter& row = state.table().rows[group.row];
    if (group.first == list.first && parameters::is_list(row)) return row.list->plural;
  }
  return "values";
}

// Adds the assignments of `field` to `slots` to the current option.
void read_assignments(const yaml::Field& field, const study::SlotRange& slots, SweptAxis& axis,
                      SweepReading& state) {
  if (!slots.list) {
    assign(axis, slots.first, keys::read_value(field, slots.first, state.reading), field.node->place);
    return;
  }
  const std::string_view noun = noun_of(slots, state);
  const std::string expected = fmt::format("a list of {} {}, as at every point", slots.count, noun);
  if (!yaml::check_list(field, expected, state.reading.problems)) return;
  const std::size_t count = field.node->items.size();
  if (count != slots.count) {
    state.reading.problems.add(field, fmt::format("found a list of {} {}", count, noun), expected);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const yaml::Field item = yaml::item_of(field, i);
    assign(axis, slots.first + i, keys::read_value(item, slots.first + i, state.reading), item.node->place);
  }
}

void note_slots(SweptAxis& axis, const study::SlotRange& slots) {
  for (std::size_t slot = slots.first; slot < slots.first + slots.count; ++slot) {
    if (std::find(axis.slots.begin(), axis.slots.end(), slot) == axis.slots.end()) axis.slots.push_back(slot);
  }
}

// The value in an option's label: a number in its shortest form, anything else as in the manifest.
std::string value_label(const SweptAxis& axis, const study::SlotRange& slots, const yaml::YamlNode& node,
                        const study::StudyTable& table) {
  if (slots.list || parameters::has_labels(table.rows[slots.first]) || axis.axis.assignments.empty() ||
      axis.axis.assignments.back().value.kind != study::Value::Kind::number) {
    return yaml::flow_text(node);
  }
  return parameters::number_text(table.rows[slots.first], axis.axis.assignments.back().value.number);
}

void read_listed(const yaml::Field& field, const study::SlotRange& slots, SweptAxis& axis,
                 SweepReading& state) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < field.node->items.size(); ++i) {
    const yaml::Field item = yaml::item_of(field, i);
    const std::size_t problems_before = state.reading.problems.size();
    read_assignments(item, slots, axis, state);
    if (state.reading.problems.size() > problems_before) continue;  // an unreadable value equals no other
    std::string label = fmt::format("{}={}", axis.name, value_label(axis, slots, *item.node, state.table()));
    if (!seen.insert(label).second) {
      state.reading.problems.add(
          item, fmt::format("duplicate value {}", yaml::in_quotes(yaml::flow_text(*item.node))),
          "different values");
    }
    finish_option(axis, std::move(label));
  }
}

void read_spaced(const yaml::Field& sweep, const yaml::Field& field, const study::SlotRange& slots,
                 SweptAxis& axis, SweepReading& state) {
  const auto& entries = field.node->entries;
  const bool known = entries.size() == 1 && (entries[0].key == "linspace" || entries[0].key == "logspace");
  if (!known || slots.list) {
    yaml::add_wrong_type(
        field,
        slots.list
            ? fmt::format("a list of lists of {}", noun_of(slots, state))
            : "a list of values, {linspace: [first, last, number]} or {logspace: [first, last, number]}",
        state.reading.problems);
    return;
  }
  const yaml::Field inner = yaml::entry_of(field, entries[0]);
  const auto spacing = read_spacing(inner, entries[0].key, max_points, state.reading.problems);
  if (!spacing || !check_point_count(sweep, spacing->count, state)) return;
  const std::vector<double> values = spaced_values(*spacing);
  std::vector<std::string> labels = spaced_labels(axis.name, values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const study::Value value = keys::checked_number(inner, slots.first, values[i], state.reading);
    assign(axis, slots.first, value, inner.node->place);
    finish_option(axis, std::move(labels[i]));
    if (std::isnan(value.number)) return;  // one report is enough
  }
}

// Reports a parameter in two axes of the grid. If the cases also give it a value, the grid takes precedence,
// with a warning.
bool take_for_grid(const yaml::Field& grid, const yaml::YamlEntry& entry, const SweptAxis& axis,
                   SweepReading& state) {
  const std::string path = yaml::entry_of(grid, entry).path;
  for (const std::size_t slot : axis.slots) {
    if (!state.in_grid.insert(slot).second) {
      state.reading.problems.add(entry.place, path,
                                 fmt::format("{} is swept twice", state.table().rows[slot].name),
                                 "each parameter in one axis of the grid");
      return false;
    }
    if (state.in_cases.count(slot) > 0) {
      state.reading.warnings.push_back(
          yaml::at_place(entry.place, path,
                         fmt::format("the values of the grid replace those of the cases for {}",
                                     state.table().rows[slot].name)));
    }
  }
  return true;
}

void read_grid(const yaml::Field& sweep, const yaml::Field& grid, std::vector<SweptAxis>& axes,
               SweepReading& state) {
  if (!yaml::check_map(grid, "a map from dotted paths to lists of values", state.reading.problems)) return;
  for (const yaml::YamlEntry& entry : grid.node->entries) {
    const auto slots = find_swept(grid, entry, state);
    if (!slots) continue;
    const yaml::Field field = yaml::entry_of(grid, entry);
    SweptAxis axis{.name = entry.key, .place = field.node->place};
    note_slots(axis, *slots);
    if (!take_for_grid(grid, entry, axis, state)) continue;
    if (field.node->kind == yaml::YamlNode::Kind::map) {
      read_spaced(sweep, field, *slots, axis, state);
    } else if (yaml::check_list(field, "a list of values, such as [1, 2]", state.reading.problems)) {
      if (field.node->items.empty()) {
        state.reading.problems.add(field, "the list is empty", "at least one value");
      } else if (check_point_count(sweep, field.node->items.size(), state)) {
        read_listed(field, *slots, axis, state);
      }
    }
    axes.push_back(std::move(axis));
  }
}

// Reads one case: a map from keys to values.
void read_case(const yaml::Field& cases, const yaml::YamlEntry& entry, SweptAxis& axis, SweepReading& state) {
  const yaml::Field field = yaml::entry_of(cases, entry);
  if (entry.key.find_first_not_of(" \t\r\n") == std::string::npos) {
    state.reading.problems.add(entry.place, field.path, "the name of the case is empty", "a name");
  }
  if (!yaml::check_map(field, "a map from dotted paths to values", state.reading.problems)) return;
  std::set<std::size_t> in_this_case;
  for (const yaml::YamlEntry& assignment : field.node->entries) {
    const auto slots = find_swept(field, assignment, state);
    if (!slots) continue;
    note_slots(axis, *slots);
    for (std::size_t slot = slots->first; slot < slots->first + slots->count; ++slot) {
      if (in_this_case.insert(slot).second) continue;
      state.reading.problems.add(assignment.place, yaml::entry_of(field, assignment).path,
                                 fmt::format("{} is given twice in this case", state.table().rows[slot].name),
                                 "one value");
      break;
    }
    read_assignments(yaml::entry_of(field, assignment), *slots, axis, state);
  }
  finish_option(axis, entry.key);
}

void read_cases(const yaml::Field& sweep, const yaml::Field& cases, std::vector<SweptAxis>& axes,
                SweepReading& state) {
  if (!yaml::check_map(cases, "a map from names to cases", state.reading.problems)) return;
  const auto& entries = cases.node->entries;
  if (entries.empty() || !check_point_count(sweep, entries.size(), state)) return;
  SweptAxis axis{.cases = true, .name = "case", .place = cases.node->place};
  for (const yaml::YamlEntry& entry : entries) read_case(cases, entry, axis, state);
  state.in_cases.insert(axis.slots.begin(), axis.slots.end());
  axes.push_back(std::move(axis));
}

// Reports keys other than grid and cases.
void check_parts(const yaml::Field& sweep, keys::Reading& reading) {
  const std::vector<std::string> parts{"grid", "cases"};
  for (const yaml::YamlEntry& entry : sweep.node->entries) {
    if (std::find(parts.begin(), parts.end(), entry.key) != parts.end()) continue;
    if (study::find_slots(entry.key, reading.plan.table)) {
      reading.problems.add(entry.place, yaml::entry_of(sweep, entry).path,
                           "a swept parameter stands in the grid or in a case",
                           fmt::format("sweep: {{grid: {{{}: [...]}}}}", entry.key));
    } else {
      parameters::add_unknown_key(sweep, entry, parts, reading.problems);
    }
  }
}

}  // namespace

std::vector<SweptAxis> read_sweep(const yaml::Field& sweep, keys::Reading& reading) {
  std::vector<SweptAxis> axes;
  if (!yaml::check_map(sweep, "a map with grid, cases or both", reading.problems)) return axes;
  check_parts(sweep, reading);
  SweepReading state{.reading = reading};
  if (const auto cases = yaml::find_field(sweep, "cases")) read_cases(sweep, *cases, axes, state);
  if (const auto grid = yaml::find_field(sweep, "grid")) read_grid(sweep, *grid, axes, state);
  return axes;
}

}  // namespace zerocount::sections
