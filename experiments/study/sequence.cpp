#include "experiments/study/sequence.hpp"

namespace zerocount::study {

std::int64_t sequence_move_count(const SequenceCycle& cycle, std::int64_t targets) {
  const std::int64_t runs = cycle.approach == SequenceApproach::bidirectional ? 2 : 1;
  return cycle.cycles * runs * (targets + 1);
}

std::vector<SequenceMove> sequence_moves(const SequenceCycle& cycle, std::int64_t targets) {
  std::vector<SequenceMove> moves;
  moves.reserve(static_cast<std::size_t>(sequence_move_count(cycle, targets)));
  for (std::int64_t c = 0; c < cycle.cycles; ++c) {
    if (cycle.approach != SequenceApproach::negative) {
      moves.push_back({-1, -1, c});
      for (std::int64_t i = 0; i < targets; ++i) moves.push_back({i, 1, c});
    }
    if (cycle.approach != SequenceApproach::positive) {
      moves.push_back({-1, 1, c});
      for (std::int64_t i = targets; i-- > 0;) moves.push_back({i, -1, c});
    }
  }
  return moves;
}

double sequence_position(const SequenceMove& move, std::span<const double> targets, double overrun) {
  if (move.target >= 0) return targets[static_cast<std::size_t>(move.target)];
  return move.direction < 0 ? targets.front() - overrun : targets.back() + overrun;
}

}  // namespace zerocount::study
