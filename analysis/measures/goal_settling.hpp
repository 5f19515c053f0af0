#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/measures/goal_counts.hpp"
#include "analysis/measures/measure_statistics.hpp"
#include "analysis/statistics/clusters/trial_clusters.hpp"
#include "core/trial/outcome.hpp"

namespace zerocount::measures {

/// Collects the settling times of the moves that one goal asks, under each condition. A goal on all moves of
/// a study without conditions needs no times of its own: they are those of its band (or tolerance), which is
/// a measure of the study.
class GoalSettling {
 public:
  GoalSettling(const CountedGoal& goal, const Shape& shape);

  /// Adds the moves of a trial. @param trial its index at the design point
  void add(std::int64_t trial, const CountedGoal& goal, std::span<const trial::MoveOutcome> moves);
  /// Adds other trials, of the same goal.
  GoalSettling& operator+=(const GoalSettling& next);
  /// [condition, or 0 without conditions] the number of moves, their extremes, median and 95 % quantile, s;
  /// empty where it collects nothing.
  std::vector<MeasureStatistics> statistics(double confidence) const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    for (auto& times : self.times_) archive(times);
  }
  /// Whether restored times can be those of so many moves.
  bool is_valid(std::int64_t moves) const;

 private:
  std::int64_t rigs_;
  std::vector<statistics::TrialClusters> times_{};  ///< [condition]
  std::vector<double> values_{};                    ///< of the current trial
};

}  // namespace zerocount::measures
