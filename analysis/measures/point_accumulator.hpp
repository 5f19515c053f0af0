#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/measures/point_statistics.hpp"
#include "analysis/measures/statistics_options.hpp"
#include "analysis/statistics/clustered_mean.hpp"
#include "analysis/statistics/histogram.hpp"
#include "analysis/statistics/trial_clusters.hpp"
#include "core/trial/outcome.hpp"

namespace zerocount {

/// What is known of the moves before they are looked at.
struct MoveKind {
  bool open_loop{false};         ///< they have torque levels, and no target
  bool final_error_known{true};  ///< false in results that do not hold it
  std::int64_t rigs{0};  ///< that the trials run on, trial i on rig i mod rigs; 0: no trials share one
};

/// Takes the trials of one design point, one after the other, and gives its statistics. The trials of one rig
/// and the moves of one trial are clusters: bounds allow for what they have in common.
///
/// Its memory grows with the number of distinct settling times, jerk counts, jerk intervals and final errors
/// (with rigs: of each rig), not with the number of trials: for one sample rate, at most with the samples of
/// a move and the counts that the rotor strays.
class PointAccumulator {
 public:
  explicit PointAccumulator(MoveKind kind = {});

  /// Adds a trial with its jerks in order of move and onset.
  /// @throws Failure (bad_data) where the trial has no move or another number of moves than those before it,
  /// its jerks are out of order or not those that its outcome counts, or its moves are not of the kind.
  void add(const TrialOutcome& trial, std::span<const Jerk> jerks);

  /// The statistics of the trials added so far.
  /// @throws Failure (bad_input) for a confidence outside (0, 1).
  PointSummary statistics(const StatisticsOptions& options = {}) const;

 private:
  void add_moves(const TrialOutcome& trial);
  void add_to_rig(const std::vector<MoveOutcome>& moves);
  void add_times(const std::vector<MoveOutcome>& moves);
  void add_final_times(const std::vector<MoveOutcome>& moves);
  void add_errors(const std::vector<MoveOutcome>& moves);
  void add_measures(const MoveOutcome& move);
  void add_jerks(const MoveOutcome& move, std::span<const Jerk> jerks);

  MoveKind kind_;
  PointSummary counted_;                    ///< the fields that are plain counts and moments
  std::vector<RigTrials> rigs_;             ///< [rig], of those that have trials
  TrialClusters settling_times_;            ///< of moves with a target
  ClusterTotals settling_totals_;           ///< of the moves that arrived
  TrialClusters final_settling_times_;      ///< likewise
  ClusterTotals final_settling_totals_;     ///< of the moves that stayed at zero error
  TrialClusters slowest_times_;             ///< of trials: of the move that took longest
  TrialClusters final_errors_;              ///< of moves with a known error
  Histogram<double> amplitudes_, periods_;  ///< of oscillations, counts and s
  Histogram<std::int64_t> jerk_counts_;
  ClusterTotals jerk_totals_;  ///< of trials
  Histogram<double> jerk_intervals_;
  RankTrend interval_trend_;
  std::int64_t one_count_jerks_{0};
  std::vector<double> intervals_;  ///< of the move at hand; kept for its memory
  std::vector<double> values_;     ///< of the trial at hand; likewise
};

}  // namespace zerocount
