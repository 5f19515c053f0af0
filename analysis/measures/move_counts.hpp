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

  /// Adds the moves of a trial. @param rigs number of rigs; 0: no trials share a rig
  void add(std::int64_t trial, std::int64_t rigs, std::int64_t moves, std::int64_t met);
  MoveCounts& operator+=(const MoveCounts& other);
  /// Whether the counts are possible for this number of trials.
  bool is_valid(std::int64_t trials, std::int64_t moves_of_trial, std::int64_t rigs) const;

  /// The number of worlds is not in the archive: it is set before.
  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.moves, self.met, self.of_trials, self.rigs);
    if (self.worlds > 0) archive(self.of_worlds);
  }
};

/// The moves in clusters: rigs, or trials where none share a rig.
statistics::ClusterSums clusters_of(const MoveCounts& counts);

/// The counts of each world, [world], as those of a study of its own: trial i, or rig r, of all is its trial
/// i div W (its rig r div W). Empty without worlds.
std::vector<MoveCounts> in_worlds(const MoveCounts& counts);

}  // namespace zerocount::measures
