#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/measures/measure_accumulator.hpp"
#include "analysis/measures/point_statistics.hpp"
#include "analysis/measures/statistics_options.hpp"
#include "analysis/statistics/histogram.hpp"
#include "analysis/statistics/trend.hpp"
#include "analysis/statistics/trial_clusters.hpp"
#include "core/trial/outcome.hpp"

namespace zerocount::measures {

/// Takes the trials of one design point, one after the other, and gives its statistics. The trials of one rig
/// and the moves of one trial are clusters: bounds allow for what they have in common.
///
/// Its memory grows with the number of distinct settling times, jerk counts, jerk intervals and final errors
/// (with rigs: of each rig), not with the number of trials: for one sample rate, at most with the samples of
/// a move and the counts that the rotor strays.
class PointAccumulator {
 public:
  /// @param table the measures that are taken; stays as long as this.
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
  void add_slowest_time(const std::vector<trial::MoveOutcome>& moves);
  void add_jerks(const trial::MoveOutcome& move, std::span<const trial::Jerk> jerks);
  statistics::SuccessClaim claim(const PointSummary& point, const StatisticsOptions& options) const;

  MoveKind kind_;
  PointSummary counted_;                                 ///< the fields that are plain counts
  std::vector<MeasureAccumulator> measures_;             ///< [row of the table]
  std::vector<std::vector<MeasureAccumulator>> levels_;  ///< [move][row of the table]
  std::vector<statistics::RigTrials> rigs_;              ///< [rig], of those that have trials
  statistics::TrialClusters slowest_times_;              ///< of trials: of the move that took longest
  std::int64_t jerks_{0};
  statistics::Histogram<double> jerk_intervals_;
  statistics::RankTrend interval_trend_;
  std::int64_t one_count_jerks_{0};
  std::vector<double> values_;  ///< of the trial or move at hand; kept for its memory
};

}  // namespace zerocount::measures
