#include "analysis/measures/goal_counts.hpp"

#include <algorithm>

namespace zerocount::measures {

std::optional<CountedGoal> counted_goal(const study::Study& study) {
  if (!study.goal) return std::nullopt;
  const std::span<const std::int64_t> bands = study.features.bands.values();
  const auto band = std::find(bands.begin(), bands.end(), study.goal->band);
  return CountedGoal{static_cast<std::size_t>(band - bands.begin()), study.goal->within};
}

void GoalCounts::add(const CountedGoal& goal, std::int64_t trial, std::int64_t rig_count,
                     std::span<const trial::MoveOutcome> of_trial) {
  const std::int64_t meeting = std::count_if(
      of_trial.begin(), of_trial.end(), [&](const trial::MoveOutcome& move) { return meets(goal, move); });
  moves += std::ssize(of_trial);
  met += meeting;
  if (rig_count == 0) {
    of_trials.add(meeting, std::ssize(of_trial));
    return;
  }
  rigs.resize(static_cast<std::size_t>(rig_count));
  statistics::RigMoves& rig = rigs[static_cast<std::size_t>(trial % rig_count)];
  ++rig.trials;
  rig.moves += std::ssize(of_trial);
  rig.met += meeting;
}

GoalCounts& GoalCounts::operator+=(const GoalCounts& other) {
  moves += other.moves;
  met += other.met;
  of_trials += other.of_trials;
  rigs.resize(std::max(rigs.size(), other.rigs.size()));
  for (std::size_t rig = 0; rig < other.rigs.size(); ++rig) {
    rigs[rig].trials += other.rigs[rig].trials;
    rigs[rig].moves += other.rigs[rig].moves;
    rigs[rig].met += other.rigs[rig].met;
  }
  return *this;
}

bool GoalCounts::is_valid(std::int64_t trials, std::int64_t moves_of_trial, std::int64_t rig_count) const {
  if (moves != trials * moves_of_trial || met < 0 || met > moves) return false;
  if (rig_count == 0) return rigs.empty() && of_trials.events == moves && of_trials.hits == met;
  if (of_trials.clusters != 0 || std::ssize(rigs) != rig_count) return false;
  std::int64_t rig_trials = 0, rig_met = 0;
  for (const statistics::RigMoves& rig : rigs) {
    if (rig.trials < 0 || rig.trials > trials || rig.met < 0 || rig.met > rig.moves ||
        rig.moves != rig.trials * moves_of_trial)
      return false;
    rig_trials += rig.trials;
    rig_met += rig.met;
  }
  return rig_trials == trials && rig_met == met;
}

statistics::ClusterSums clusters_of(const GoalCounts& counts) {
  statistics::ClusterSums sums = counts.of_trials;
  for (const statistics::RigMoves& rig : counts.rigs) sums.add(rig.met, rig.moves);
  return sums;
}

}  // namespace zerocount::measures
