#include "experiments/language/slots.hpp"

#include <charconv>

#include <fmt/format.h>

namespace zerocount {
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

std::size_t slot_count(std::size_t moves) {
  return parameter_table().size() + moves;
}

std::size_t target_slot(std::size_t move) {
  return parameter_table().size() + move;
}

std::size_t targets_row() {
  const auto table = parameter_table();
  std::size_t row = 0;
  while (!table[row].per_move) ++row;
  return row;
}

std::size_t row_of_slot(std::size_t slot) {
  return slot < parameter_table().size() ? slot : targets_row();
}

std::string slot_name(std::size_t slot) {
  const auto table = parameter_table();
  if (slot < table.size()) return std::string(table[slot].name);
  return fmt::format("{}.{}", table[targets_row()].name, slot - table.size());
}

std::size_t slot_sobol_dimension(std::size_t slot) {
  const auto table = parameter_table();
  return slot < table.size() ? table[slot].sobol_dimension
                             : first_sobol_dimension_of_moves + slot - table.size();
}

std::vector<std::size_t> slots_in_table_order(std::size_t moves) {
  std::vector<std::size_t> slots;
  const auto table = parameter_table();
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (!table[row].per_move) slots.push_back(row);
    for (std::size_t move = 0; table[row].per_move && move < moves; ++move)
      slots.push_back(target_slot(move));
  }
  return slots;
}

std::optional<SlotRange> find_slots(std::string_view path, std::size_t moves) {
  const std::size_t targets = targets_row();
  if (const auto row = find_parameter(path)) {
    if (*row == targets) return SlotRange{target_slot(0), moves, true};
    return SlotRange{*row, 1, false};
  }
  const auto move = index_below(path, parameter_table()[targets].name);
  if (!move || *move >= moves) return std::nullopt;
  return SlotRange{target_slot(*move), 1, false};
}

}  // namespace zerocount
