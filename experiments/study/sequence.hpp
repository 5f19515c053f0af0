#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace zerocount::study {

/// One move of a sequence (`command.sequence`).
struct SequenceMove {
  /// Index of the target in the list; −1: the move goes beyond the first or last target.
  std::int64_t target{-1};
  int direction{1};       ///< direction of the approach: 1 from below, −1 from above
  std::int64_t cycle{0};  ///< index of the cycle, from 0
};

/// From which side the moves of a sequence approach their targets.
enum class SequenceApproach {
  bidirectional,  ///< from below (positive direction), then from above
  positive,       ///< from below only
  negative        ///< from above only
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

/// Maximum number of moves of a sequence in one trial.
constexpr std::int64_t max_sequence_moves = 100'000;

/// Number of moves of a sequence with m targets: cycles·(2m + 2), or cycles·(m + 1) if the targets are
/// approached from one side only.
std::int64_t sequence_move_count(const SequenceCycle& cycle, std::int64_t targets);

/// All moves of a sequence in order. A move beyond the first (last) target has the direction −1 (1), the
/// direction of its travel within a cycle.
std::vector<SequenceMove> sequence_moves(const SequenceCycle& cycle, std::int64_t targets);

/// Target position of a move of a sequence, counts.
/// @param targets targets in ascending order, counts
/// @param overrun distance d by which a move goes beyond the first or last target, counts
double sequence_position(const SequenceMove& move, std::span<const double> targets, double overrun);

}  // namespace zerocount::study
