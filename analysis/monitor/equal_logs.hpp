#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/monitor/move_log.hpp"

namespace zerocount::monitor {

/// Number of equal moves with which both sequences begin. It is the length of the shorter sequence if the
/// other one begins with the same moves, and otherwise 0.
///
/// Two moves are equal if all measures that both sides have agree to nine digits. Units, the order of columns
/// and the notation of numbers therefore make no difference. If the lengths differ, the equal moves must have
/// at least ten different rows, so that they are unlikely to be equal by chance. The number is 0 if the sides
/// have no measure in common.
std::int64_t equal_moves(const Moves& one, const Moves& other);

/// Logs with the same moves in the same order.
struct EqualLogs {
  std::vector<std::size_t> logs;  ///< Indices of the logs, ascending, at least two.
  std::int64_t moves;             ///< Number of equal moves at the beginning of these logs.
  bool whole;                     ///< True if all of these logs have the same number of moves.
  bool few_values;  ///< True if there are fewer than ten different rows: the logs may agree by chance.
};

/// The first log that equals later ones, together with these; nothing if all logs differ.
std::optional<EqualLogs> equal_logs(std::span<const MoveLog> logs);

}  // namespace zerocount::monitor
