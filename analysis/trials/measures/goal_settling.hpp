#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/basis/statistics/clusters/trial_clusters.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/trials/measures/measure_statistics.hpp"
#include "analysis/trials/measures/move_counts.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/goal.hpp"

namespace zerocount::measures {

/// Settling times of the moves that one goal judges, compared with the times allowed.
struct SettlingTimes {
  MeasureStatistics times;  ///< Number of settling times, their extremes, median and 95 % quantile, s.
  /// Longest time that the goal allows to a move, s from the start of the move.
  double allowed{statistics::unknown};
  /// 95 % quantile of settling time divided by allowed time; infinite if this proportion of the moves does
  /// not settle.
  double time_ratio{statistics::unknown};
};

/// Collects the settling times of the moves that one goal judges, in each setting (a condition at an age).
/// Nothing is collected if the study has no settings and the goal judges all moves and allows all of them the
/// same time: the settling time of the goal's band or tolerance is then a measure of the study.
class GoalSettling {
 public:
  GoalSettling(const MoveCriterion& criterion, const Shape& shape);

  /// Adds the settling times of a trial.
  /// @param trial index of the trial at the design point
  /// @param criterion the criterion of the goal
  void add(std::int64_t trial, const MoveCriterion& criterion, std::span<const trial::MoveOutcome> moves);
  /// Adds the settling times of another accumulator for the same goal.
  GoalSettling& operator+=(const GoalSettling& next);
  /// [setting, or 0 without settings] Statistics of the settling times; empty if nothing is collected.
  /// @param confidence confidence of the bounds
  std::vector<SettlingTimes> statistics(double confidence) const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    for (auto& times : self.times_) archive(times);
    for (auto& ratios : self.time_ratios_) archive(ratios);
    for (auto& allowed : self.allowed_) archive(allowed);
  }
  /// Whether the settling times read from a file are possible for this number of moves.
  bool is_valid(std::int64_t moves) const;

 private:
  std::int64_t machines_;
  study::TimeLimit within_;
  std::vector<double> values_{};  ///< Settling times of the trial that is being added, s; working memory.
  std::vector<statistics::TrialClusters> times_{};  ///< [setting] Settling times, s, grouped by trial.
  /// [setting] Settling times divided by allowed times; empty if all moves are allowed the same time.
  std::vector<statistics::TrialClusters> time_ratios_{};
  /// [setting] Longest allowed time, s; empty if all moves are allowed the same time.
  std::vector<double> allowed_{};
};

}  // namespace zerocount::measures
