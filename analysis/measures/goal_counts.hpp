#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/statistics/clustered_proportion.hpp"
#include "analysis/statistics/rig_proportion.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::measures {

/// The goal of a study as the moves are counted by it.
struct CountedGoal {
  std::size_t slot{0};  ///< of its band, in MoveOutcome::bands
  double within{0.0};   ///< s
};

/// The goal of the study as it is counted; nothing without one.
std::optional<CountedGoal> counted_goal(const study::Study& study);

/// Whether the error of the move is within the goal's band for good in time. A sample at the very end of that
/// time is in time, although k·T may be rounded up.
inline bool meets(const CountedGoal& goal, const trial::MoveOutcome& move) {
  constexpr double rounding = 1.0 + 1e-12;
  return move.bands[goal.slot].settling_time <= goal.within * rounding;  // false for NaN
}

/// The moves of a design point that meet the goal.
struct GoalCounts {
  std::int64_t moves{0};
  std::int64_t met{0};
  statistics::ClusterSums of_trials;       ///< moves; each trial is a cluster. Empty with rigs
  std::vector<statistics::RigMoves> rigs;  ///< [rig]; empty without rigs

  /// @param rigs number of rigs; 0: no trials share a rig
  void add(const CountedGoal& goal, std::int64_t trial, std::int64_t rigs,
           std::span<const trial::MoveOutcome> moves);
  GoalCounts& operator+=(const GoalCounts& other);
  /// Whether the counts are possible for this number of trials.
  bool is_valid(std::int64_t trials, std::int64_t moves_of_trial, std::int64_t rigs) const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.moves, self.met, self.of_trials, self.rigs);
  }
};

/// The moves that meet the goal, in clusters: rigs, or trials where none share a rig.
statistics::ClusterSums clusters_of(const GoalCounts& counts);

}  // namespace zerocount::measures
