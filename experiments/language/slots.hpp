#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/parameters/parameter_table.hpp"

namespace zerocount {

/// Number of slots of a plan whose trials have `moves` moves (see plan.hpp).
std::size_t slot_count(std::size_t moves);

/// Slot of the target of `move`.
std::size_t target_slot(std::size_t move);

/// Row of the per_move parameter, the targets.
std::size_t targets_row();

/// Row of the table of parameters that says what the slot holds.
std::size_t row_of_slot(std::size_t slot);

/// Dotted path of the slot: "friction.k1", "command.targets.0".
std::string slot_name(std::size_t slot);

/// Fixed Sobol dimension of the slot.
std::size_t slot_sobol_dimension(std::size_t slot);

/// All slots in use, in the order of the table, the targets where their row stands.
std::vector<std::size_t> slots_in_table_order(std::size_t moves);

/// What a dotted path in a sweep names: the slots that one value of it fills, one, or all targets for
/// "command.targets".
struct SlotRange {
  std::size_t first{0};
  std::size_t count{1};
  bool list{false};  ///< its value is a list, one entry a slot
};
std::optional<SlotRange> find_slots(std::string_view path, std::size_t moves);

}  // namespace zerocount
