#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/machine/monitor/move_log.hpp"

namespace zerocount::monitor {

/// Number of equal moves at the beginning of the two sequences. It is the length of the shorter sequence if
/// the longer one begins with the same moves (or is the same), and otherwise 0.
///
/// Two moves are equal if all measures that both sides have agree to nine digits. Units, the order of columns
/// and the notation of numbers therefore make no difference. If the lengths differ, the equal moves must have
/// at least ten different rows, so that they are unlikely to be equal by chance. The number is 0 if the sides
/// have no measure in common.
std::int64_t equal_moves(const Moves& one, const Moves& other);

/// A set of logs that have the same moves in the same order, at least at their beginning.
struct EqualLogs {
  std::vector<std::size_t> logs;  ///< Indices of the logs, ascending, at least two.
  std::int64_t moves;             ///< Number of equal moves at the beginning of these logs.
  bool whole;                     ///< True if all of these logs have the same number of moves.
  bool few_values;  ///< True if there are fewer than ten different rows: the logs may agree by chance.
};

/// Among the logs, the first one that equals any later log, together with all later logs that equal it.
/// Nothing if all logs differ.
std::optional<EqualLogs> equal_logs(std::span<const MoveLog> logs);

}  // namespace zerocount::monitor
