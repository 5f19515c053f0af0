#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace zerocount::study {

/// One move of a sequence (`command.sequence`).
struct SequenceMove {
  std::int64_t target{-1};  ///< index in the list of targets; −1: beyond the first or last target
  int direction{1};         ///< direction of the approach: 1 from below, −1 from above
  std::int64_t cycle{0};    ///< index of the cycle, from 0
};

/// Approach direction of a sequence.
enum class SequenceApproach {
  bidirectional,  ///< from below, then from above
  positive,       ///< from below
  negative        ///< from above
};

/// The standard test cycle of ISO 230-2 (bidirectional) and its unidirectional halves.
///
/// With the targets P1 < … < Pm and the overrun d, a bidirectional cycle goes to P1 − d, P1, …, Pm, Pm + d,
/// Pm, …, P1; a positive one to P1 − d, P1, …, Pm; a negative one to Pm + d, Pm, …, P1. So all targets of one
/// run, including the first, are approached from the same side.
struct SequenceCycle {
  std::int64_t cycles{5};  ///< number of repetitions; 5 as in the standard
  SequenceApproach approach{SequenceApproach::bidirectional};
};

/// Maximum number of moves of a sequence.
constexpr std::int64_t max_sequence_moves = 100'000;

/// Number of moves with m targets: cycles·(2m + 2), or cycles·(m + 1) from one side.
std::int64_t sequence_move_count(const SequenceCycle& cycle, std::int64_t targets);

/// All moves in order. A move beyond the first (last) target has the direction −1 (1), the direction of its
/// travel within a cycle.
std::vector<SequenceMove> sequence_moves(const SequenceCycle& cycle, std::int64_t targets);

/// Target of a move, counts.
/// @param targets in ascending order, counts.
/// @param overrun d, counts.
double sequence_position(const SequenceMove& move, std::span<const double> targets, double overrun);

}  // namespace zerocount::study
