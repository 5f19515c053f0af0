#include "experiments/study/slots.hpp"

#include <charconv>

#include <fmt/format.h>

#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::study {
namespace {

// The number in "name.<number>", written without leading zeros.
std::optional<std::size_t> index_below(std::string_view path, std::string_view name) {
  if (path.size() <= name.size() + 1 || path.substr(0, name.size()) != name || path[name.size()] != '.') {
    return std::nullopt;
  }
  const std::string_view digits = path.substr(name.size() + 1);
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  if (digits.size() > 1 && digits.front() == '0') return std::nullopt;
  return index;
}

}  // namespace

std::string_view listed_noun(const ListedValues& list) {
  const std::string_view name = parameters::parameter_table()[list.row].name;
  return name.substr(name.rfind('.') + 1);
}

std::size_t slot_count(const ListedValues& list) {
  return parameters::parameter_table().size() + list.count;
}

std::size_t listed_slot(std::size_t i) {
  return parameters::parameter_table().size() + i;
}

std::size_t row_of_slot(std::size_t slot, const ListedValues& list) {
  return slot < parameters::parameter_table().size() ? slot : list.row;
}

std::string slot_name(std::size_t slot, const ListedValues& list) {
  const auto table = parameters::parameter_table();
  if (slot < table.size()) return std::string(table[slot].name);
  return fmt::format("{}.{}", table[list.row].name, slot - table.size());
}

std::size_t slot_sobol_dimension(std::size_t slot) {
  const auto table = parameters::parameter_table();
  return slot < table.size() ? table[slot].sobol_dimension
                             : parameters::first_sobol_dimension_of_moves + slot - table.size();
}

std::vector<std::size_t> slots_in_table_order(const ListedValues& list) {
  std::vector<std::size_t> slots;
  const auto table = parameters::parameter_table();
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (!table[row].listed) slots.push_back(row);
    for (std::size_t i = 0; row == list.row && i < list.count; ++i) slots.push_back(listed_slot(i));
  }
  return slots;
}

std::optional<SlotRange> find_slots(std::string_view path, const ListedValues& list) {
  const auto table = parameters::parameter_table();
  if (const auto row = parameters::find_parameter(path)) {
    if (*row == list.row) return SlotRange{listed_slot(0), list.count, true};
    if (table[*row].listed) return std::nullopt;
    return SlotRange{*row, 1, false};
  }
  const auto index = index_below(path, table[list.row].name);
  if (!index || *index >= list.count) return std::nullopt;
  return SlotRange{listed_slot(*index), 1, false};
}

std::optional<std::size_t> find_listed_row(std::string_view path) {
  const auto table = parameters::parameter_table();
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (!table[row].listed) continue;
    if (path == table[row].name || index_below(path, table[row].name)) return row;
  }
  return std::nullopt;
}

}  // namespace zerocount::study
