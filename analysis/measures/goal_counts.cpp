#include "analysis/measures/goal_counts.hpp"

#include <algorithm>

namespace zerocount::measures {

std::optional<CountedGoal> counted_goal(const study::Study& study) {
  if (!study.goal) return std::nullopt;
  const std::span<const std::int64_t> bands = study.features.bands.values();
  const auto band = std::find(bands.begin(), bands.end(), study.goal->band);
  return CountedGoal{static_cast<std::size_t>(band - bands.begin()), study.goal->within};
}

void count_moves(MoveCounts& counts, const CountedGoal& goal, std::int64_t trial, std::int64_t rigs,
                 std::span<const trial::MoveOutcome> moves) {
  const std::int64_t met = std::count_if(moves.begin(), moves.end(),
                                         [&](const trial::MoveOutcome& move) { return meets(goal, move); });
  counts.add(trial, rigs, std::ssize(moves), met);
}

}  // namespace zerocount::measures
