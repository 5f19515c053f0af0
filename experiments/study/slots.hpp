#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/plan.hpp"

namespace zerocount::study {

/// Noun for the values of the list: "targets", "levels".
std::string_view listed_noun(const ListedValues& list);

/// Number of slots of a plan with this list (see plan.hpp).
std::size_t slot_count(const ListedValues& list);

/// Slot of value i of the list.
std::size_t listed_slot(std::size_t i);

/// Row of the table of parameters that describes the slot.
std::size_t row_of_slot(std::size_t slot, const ListedValues& list);

/// Dotted path of the slot: "friction.k1", "command.targets.0".
std::string slot_name(std::size_t slot, const ListedValues& list);

/// Fixed Sobol dimension of the slot.
std::size_t slot_sobol_dimension(std::size_t slot);

/// All slots in use, in the order of the table; the values of the list at the position of their row.
std::vector<std::size_t> slots_in_table_order(const ListedValues& list);

/// The slots of a dotted path in a sweep: one slot, or all slots of the list for "command.targets".
struct SlotRange {
  std::size_t first{0};
  std::size_t count{1};
  bool list{false};  ///< its value is a list with one entry per slot
};
std::optional<SlotRange> find_slots(std::string_view path, const ListedValues& list);

/// The listed parameter of the dotted path or of one of its items, even if the study does not use it.
std::optional<std::size_t> find_listed_row(std::string_view path);

}  // namespace zerocount::study
