#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/measures/measure_accumulator.hpp"
#include "analysis/measures/point_statistics.hpp"
#include "analysis/statistics/histogram.hpp"
#include "analysis/statistics/trend.hpp"
#include "analysis/statistics/trial_clusters.hpp"
#include "core/trial/outcome.hpp"

namespace zerocount::measures {

/// Collects the trials of one design point and computes its statistics. The trials of one rig and the moves
/// of one trial are clusters: the bounds account for their correlation.
///
/// The memory grows with the number of distinct settling times, jerk counts, jerk intervals and final errors
/// (with rigs: of each rig), not with the number of trials. For one sample rate it is limited by the samples
/// of a move and the maximum error in counts.
class PointAccumulator {
 public:
  /// @param table the measures; must outlive this object.
  explicit PointAccumulator(const MoveKind& kind = {},
                            const layout::MeasureTable& table = layout::measure_table());

  /// Adds a trial with its jerks in order of move and onset.
  /// @throws Failure (bad_data) where the trial has no move or another number of moves than those before it,
  /// its jerks are out of order or not those that its outcome counts, or its moves are not of the kind.
  void add(const trial::TrialOutcome& trial, std::span<const trial::Jerk> jerks);

  /// The statistics of the trials added so far.
  /// @throws Failure (bad_input) for a confidence outside (0, 1).
  PointSummary statistics(const StatisticsOptions& options = {}) const;

 private:
  void add_moves(const std::vector<trial::MoveOutcome>& moves);
  void add_level(std::size_t level, std::span<const trial::MoveOutcome> move);
  void add_to_rig(const std::vector<trial::MoveOutcome>& moves);
  void add_trial_settling_time(const std::vector<trial::MoveOutcome>& moves);
  void add_jerks(const trial::MoveOutcome& move, std::span<const trial::Jerk> jerks);
  statistics::SuccessClaim claim(const PointSummary& point, const StatisticsOptions& options) const;

  MoveKind kind_;
  PointSummary counted_;                                 ///< the fields that are plain counts
  std::vector<MeasureAccumulator> measures_;             ///< [row of the table]
  std::vector<std::vector<MeasureAccumulator>> levels_;  ///< [move][row of the table]
  std::vector<statistics::RigTrials> rigs_;              ///< [rig], of those that have trials
  statistics::TrialClusters trial_settling_times_;       ///< of each trial: of its slowest move
  std::int64_t jerks_{0};
  statistics::Histogram<double> jerk_intervals_;
  statistics::RankTrend interval_trend_;
  std::int64_t one_count_jerks_{0};
  std::vector<double> values_;  ///< of the current trial or move
};

}  // namespace zerocount::measures
