#pragma once

#include <cstdint>
#include <vector>

#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/clusters/rig_proportion.hpp"

namespace zerocount::measures {

/// The moves of a design point that meet a condition.
struct MoveCounts {
  std::int64_t moves{0};
  std::int64_t met{0};
  statistics::ClusterSums of_trials;       ///< moves; each trial is a cluster. Empty with rigs
  std::vector<statistics::RigMoves> rigs;  ///< [rig]; empty without rigs
  /// Number of worlds: trial i, or rig r, is in world i (r) mod worlds; 0: none. Set before trials are added.
  std::int64_t worlds{0};
  std::vector<statistics::ClusterSums> of_worlds{};  ///< [world] as of_trials; empty without worlds
  /// [condition] the moves under it, counted as those of a study of its own with as many worlds, whose trials
  /// are the draws (study::TrialTurns); empty without conditions. See tell_apart().
  std::vector<MoveCounts> of_conditions{};

  /// Lets the counts tell worlds and conditions apart. To be called before trials are added. @param
  /// conditions 0: none
  void tell_apart(std::int64_t worlds_of_study, std::int64_t conditions);
  /// Adds the moves of a trial. @param rigs number of rigs; 0: no trials share a rig
  void add(std::int64_t trial, std::int64_t rigs, std::int64_t moves, std::int64_t met);
  /// Adds all moves of a rig under one condition. @param condition 0 without conditions
  void add_rig(std::size_t rig, std::size_t condition, const statistics::RigMoves& of_rig);
  MoveCounts& operator+=(const MoveCounts& other);
  /// Whether the counts are possible for this number of trials.
  bool is_valid(std::int64_t trials, std::int64_t moves_of_trial, std::int64_t rigs) const;

  /// The numbers of worlds and conditions are not in the archive: they are set before.
  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.moves, self.met, self.of_trials, self.rigs);
    if (self.worlds > 0) archive(self.of_worlds);
    for (auto& condition : self.of_conditions) archive(condition);
  }
};

/// The moves in clusters: rigs, or trials where none share a rig.
statistics::ClusterSums clusters_of(const MoveCounts& counts);

/// The counts of each world, [world], as those of a study of its own: trial i, or rig r, of all is its trial
/// i div W (its rig r div W). Empty without worlds.
std::vector<MoveCounts> in_worlds(const MoveCounts& counts);

/// The counts under each condition, [condition], as those of a study of its own: draw j is its trial j, and
/// in_worlds() tells its worlds apart. Each has its own moves of each rig. Empty without conditions.
inline const std::vector<MoveCounts>& in_conditions(const MoveCounts& counts) {
  return counts.of_conditions;
}

/// The counts under one condition; without conditions all.
inline const MoveCounts& under_condition(const MoveCounts& counts, std::size_t condition) {
  return counts.of_conditions.empty() ? counts : counts.of_conditions.at(condition);
}

}  // namespace zerocount::measures
