#include "analysis/measures/move_counts.hpp"

#include <algorithm>
#include <cstddef>

namespace zerocount::measures {

void MoveCounts::add(std::int64_t trial, std::int64_t rig_count, std::int64_t of_trial,
                     std::int64_t meeting) {
  moves += of_trial;
  met += meeting;
  if (rig_count == 0) {
    of_trials.add(meeting, of_trial);
    return;
  }
  rigs.resize(static_cast<std::size_t>(rig_count));
  statistics::RigMoves& rig = rigs[static_cast<std::size_t>(trial % rig_count)];
  ++rig.trials;
  rig.moves += of_trial;
  rig.met += meeting;
}

MoveCounts& MoveCounts::operator+=(const MoveCounts& other) {
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

bool MoveCounts::is_valid(std::int64_t trials, std::int64_t moves_of_trial, std::int64_t rig_count) const {
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

statistics::ClusterSums clusters_of(const MoveCounts& counts) {
  statistics::ClusterSums sums = counts.of_trials;
  for (const statistics::RigMoves& rig : counts.rigs) sums.add(rig.met, rig.moves);
  return sums;
}

}  // namespace zerocount::measures
