#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/monitor/move_log.hpp"

namespace zerocount::monitor {

/// Number of moves with which both begin and that are equal one by one: those of the shorter one, or 0.
///
/// Moves are equal if all measures are that both have, to nine digits, so that units, the order of columns
/// and the notation of numbers make no difference. If one is longer, chance must be unlikely: the equal moves
/// have at least ten different rows. 0 without a measure in common.
std::int64_t equal_moves(const Moves& one, const Moves& other);

/// Logs with the same moves in the same order.
struct EqualLogs {
  std::vector<std::size_t> logs;  ///< indices, ascending, at least two
  std::int64_t moves;             ///< that are equal
  bool whole;                     ///< no log of them has more moves
  bool few_values;                ///< fewer than ten different rows: the logs may be equal by chance
};

/// The first logs that are equal; nothing if each differs from all others.
std::optional<EqualLogs> equal_logs(std::span<const MoveLog> logs);

}  // namespace zerocount::monitor
