#include "experiments/study/study_table.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <string>

#include <fmt/format.h>

namespace zerocount::study {
namespace {

// Whether the path is "name.<number>", the number written without leading zeros.
bool is_value_of(std::string_view path, std::string_view name) {
  if (path.size() <= name.size() + 1 || path.substr(0, name.size()) != name || path[name.size()] != '.') {
    return false;
  }
  const std::string_view digits = path.substr(name.size() + 1);
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc{} || end != digits.data() + digits.size()) return false;
  return digits.size() == 1 || digits.front() != '0';
}

// Adds the slots of a row: its own, and those of the groups that follow it.
void append_slots(const StudyTable& table, std::size_t row, std::vector<std::size_t>& slots) {
  if (parameters::has_value(table.rows[row])) slots.push_back(row);
  for (const RowGroup& group : table.groups) {
    for (std::size_t i = 0; group.row == row && i < group.count; ++i)
      append_slots(table, group.first + i, slots);
  }
}

}  // namespace

void use_si_positions(StudyTable& table) {
  for (parameters::Parameter& row : table.rows) {
    if (row.is_position) row = parameters::in_si_positions(row);
  }
}

RowGroup add_list(StudyTable& table, std::size_t row, std::size_t count) {
  const RowGroup group{row, table.rows.size(), count};
  const parameters::Parameter list = table.rows[row];
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& name = table.names->emplace_back(fmt::format("{}.{}", list.name, i));
    table.rows.push_back(parameters::value_row(list, i, name));
  }
  table.groups.push_back(group);
  return group;
}

RowGroup add_element(StudyTable& table, const parameters::ElementList& list, std::size_t index,
                     const parameters::ElementForm& form) {
  const auto row_of_key = [&](std::string_view key) {
    return parameters::find_parameter(fmt::format("{}.#.{}", list.path, key)).value();
  };
  const std::size_t first_key = row_of_key(list.forms.front().keys.front());
  const RowGroup group{first_key, table.rows.size(), form.keys.size()};
  for (const std::string_view key : form.keys) {
    const std::string& name = table.names->emplace_back(fmt::format("{}.{}.{}", list.path, index, key));
    table.rows.push_back(
        parameters::element_row(parameters::parameter_table()[row_of_key(key)], index, name));
  }
  table.groups.push_back(group);
  return group;
}

RowGroup add_plugin(StudyTable& table, const plugin::PluginDescription& plugin) {
  const auto of_controller = [](const parameters::Parameter& row) {
    return row.name.starts_with("controller.");
  };
  const auto sections = parameters::parameter_table();
  const auto last = std::find_if(sections.rbegin(), sections.rend(), of_controller);
  const RowGroup group{static_cast<std::size_t>(std::distance(last, sections.rend())) - 1, table.rows.size(),
                       plugin.parameters.size()};
  for (const plugin::PluginParameter& parameter : plugin.parameters) {
    const std::string& name =
        table.names->emplace_back(fmt::format("controller.parameters.{}", parameter.name));
    table.rows.push_back(parameters::plugin_row(name, table.rows.size() - group.first, parameter));
  }
  table.groups.push_back(group);
  return group;
}

std::size_t rate_row(StudyTable& table, std::size_t row) {
  const std::string name = fmt::format("{}{}", table.rows[row].name, suffix_of_rate);
  const auto known = std::ranges::find(table.rows, std::string_view(name), &parameters::Parameter::name);
  if (known != table.rows.end()) return static_cast<std::size_t>(known - table.rows.begin());
  table.groups.push_back({row, table.rows.size(), 1});
  const std::string& kept = table.names->emplace_back(name);
  const std::string& meaning =
      table.names->emplace_back(fmt::format("rate at which {} changes with age", table.rows[row].name));
  parameters::Parameter rate;
  rate.name = kept;
  rate.unit = "1";
  rate.meaning = meaning;
  rate.range = numerics::all_numbers();
  rate.of_machine = true;
  table.rows.push_back(rate);
  return table.groups.back().first;
}

std::optional<RowGroup> find_list(const StudyTable& table, std::size_t row) {
  const auto found = std::find_if(table.groups.begin(), table.groups.end(),
                                  [row](const RowGroup& group) { return group.row == row; });
  if (found == table.groups.end()) return std::nullopt;
  return *found;
}

std::vector<std::size_t> slots_in_table_order(const StudyTable& table) {
  std::vector<std::size_t> slots;
  for (std::size_t row = 0; row < parameters::parameter_table().size(); ++row)
    append_slots(table, row, slots);
  return slots;
}

std::optional<SlotRange> find_slots(std::string_view path, const StudyTable& table) {
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (!parameters::is_named(table.rows[row], path)) continue;
    if (parameters::has_value(table.rows[row])) return SlotRange{row, 1, false};
    const auto values = parameters::is_list(table.rows[row]) ? find_list(table, row) : std::nullopt;
    if (!values) return std::nullopt;
    return SlotRange{values->first, values->count, true};
  }
  return std::nullopt;
}

std::optional<std::size_t> find_list_row(std::string_view path) {
  const auto table = parameters::parameter_table();
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (!parameters::is_list(table[row])) continue;
    if (path == table[row].name || is_value_of(path, table[row].name)) return row;
  }
  return std::nullopt;
}

}  // namespace zerocount::study
