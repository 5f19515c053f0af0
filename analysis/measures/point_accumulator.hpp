#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/measures/goal_counts.hpp"
#include "analysis/measures/measure_statistics.hpp"
#include "analysis/measures/point_statistics.hpp"
#include "analysis/statistics/change_point.hpp"
#include "analysis/statistics/clusters/clustered_mean.hpp"
#include "analysis/statistics/clusters/trial_clusters.hpp"
#include "analysis/statistics/sums/histogram.hpp"
#include "analysis/statistics/sums/state.hpp"
#include "core/trial/outcome.hpp"

namespace zerocount::measures {

/// The moves of successive trials of a design point.
struct MovesOfTrials {
  std::int64_t first_trial{0};                       ///< Index of the first trial at the point.
  std::size_t of_trial{1};                           ///< Number of moves of a trial.
  std::span<const trial::MoveOutcome* const> moves;  ///< [trial, move]

  std::int64_t trials() const { return std::ssize(moves) / static_cast<std::int64_t>(of_trial); }
};

/// Properties that all moves of a study share.
struct MoveKind {
  bool open_loop{false};  ///< torque levels in place of targets
  Shape shape{};
  std::vector<CountedGoal> goals{};
  /// [goal] the criterion for the load, if the goal has study::Goal::beside_load. The vector is empty if no
  /// goal has it.
  std::vector<std::optional<CountedGoal>> for_the_load{};

  bool has_observed_counts{false};  ///< Whether the study is compared with counts observed on a real machine.

  /// Whether trials are counted as well as their moves (PointSummary::trials_of_groups).
  bool counts_trials() const {
    return shape.worlds > 0 || shape.settings > 0 || (has_observed_counts && !goals.empty());
  }
};

/// The properties of the moves of a study.
MoveKind move_kind(const study::Study& study);

/// Source of the random numbers for the resampling (bootstrap) of a design point.
struct BootstrapDraws {
  std::uint64_t seed{0};    ///< Seed of the study.
  std::uint32_t stream{0};  ///< Number of the design point.
};

/// Settings of the statistics of a design point.
struct StatisticsOptions {
  double confidence{statistics::summary_confidence};
  std::optional<BootstrapDraws> bootstrap{};  ///< Empty: the bounds of means are not computed.
  /// Whether the outcomes decided the number of trials. The bounds of claims about all machines must then
  /// hold at any stopping time.
  bool stopped_by_outcomes{false};
};

/// Collects one measure of the trials of a design point and computes its statistics. The trials of one
/// machine and the moves of one trial are clusters: the bounds account for their correlation.
///
/// Measures that are summed over a trial, and measures with quantiles, are kept as histograms. The memory
/// grows with the number of distinct values, not with the number of trials.
class MeasureAccumulator {
 public:
  /// @param measure must outlive this object. @param reported the statistics that are reported of the measure
  /// at a point, or at a level.
  MeasureAccumulator(const layout::Measure& measure, const layout::ReportedStatistics& reported,
                     const MoveKind& kind);

  void add(const MovesOfTrials& some);
  /// Adds the trials of another accumulator of the same measure.
  MeasureAccumulator& operator+=(const MeasureAccumulator& next);
  MeasureStatistics statistics(const StatisticsOptions& options) const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.trials_, self.moments_, self.clusters_, self.totals_, self.by_move_, self.judged_,
            self.hits_);
    if (self.counts_moves_) archive(self.of_moves_);
  }
  /// Whether the restored sums are possible for this measure. @param moves number of moves of each trial
  bool is_valid(std::int64_t trials, std::int64_t moves) const;

 private:
  bool has_valid_qualities(std::int64_t moves) const;
  bool has_valid_totals() const;
  void add_qualities(const MovesOfTrials& some);
  void add_sums(const MovesOfTrials& some);
  void add_values(const MovesOfTrials& some);
  void add_totals(std::int64_t trial, std::size_t of_trial);
  RateWithBounds rate(double confidence) const;
  RateWithBounds rate_of_moves(double confidence) const;
  statistics::ConfidenceInterval bootstrap_bounds(const StatisticsOptions& options) const;

  const layout::Measure* measure_;
  const layout::ReportedStatistics* reported_;
  MoveKind kind_;
  bool in_clusters_;      ///< whether values are kept in clusters; otherwise only their moments
  bool has_mean_bounds_;  ///< whether bootstrap bounds of the mean are reported
  bool counts_moves_;     ///< whether the proportion of moves is reported
  std::int64_t trials_{0};
  statistics::MomentSums moments_;
  statistics::TrialClusters clusters_;
  statistics::ClusterTotals totals_;
  std::vector<std::int64_t> by_move_;  ///< [move] trials whose move has the quality; empty without trials
  statistics::ByCluster<> judged_;  ///< [machine] number of trials; without machines all count as machine 0
  statistics::ByCluster<> hits_;    ///< [machine] number of trials with the quality; indexed like judged_
  CellCounts of_moves_;             ///< Counts of the moves with the quality, if counts_moves_.
  std::vector<double> values_;      ///< Values of the trials that are being added.
};

/// Collects the trials of one design point and computes its statistics. The trials of one machine and the
/// moves of one trial are clusters: the bounds account for their correlation.
///
/// The memory grows with the number of distinct settling times, jerk counts, jerk intervals and final errors
/// (with machines: of each machine), not with the number of trials. For one sample rate it is limited by the
/// samples of a move and the maximum error in counts.
class PointAccumulator {
 public:
  /// @param table the measures; must outlive this object. @param first_trial index of the first trial that
  /// is added
  explicit PointAccumulator(const MoveKind& kind = {},
                            const layout::MeasureTable& table = layout::measure_table(),
                            std::int64_t first_trial = 0);

  /// Adds a trial with its jerks in order of move and onset.
  /// @throws Failure (bad_data) if the trial has no move or another number of moves than earlier trials, if
  /// its jerks are out of order or their number differs from the outcome, or if its moves are not of the
  /// kind.
  void add(const trial::TrialOutcome& trial, std::span<const trial::Jerk> jerks);

  /// First part of add(), for many trials at once: adds their measures, column by column. add_counts() must
  /// be called for each of these trials too.
  /// @param moves [trial, move] @param moves_of_trial number of moves of each trial
  void add_measures(std::span<const trial::MoveOutcome* const> moves, std::size_t moves_of_trial);
  /// Second part of add(), for one trial: adds all but the measures.
  void add_counts(std::span<const trial::MoveOutcome> moves, std::span<const trial::Jerk> jerks);

  /// Adds the trials of the same point that follow those of this object. The statistics do not depend on how
  /// the trials of a point were divided.
  PointAccumulator& operator+=(const PointAccumulator& next);

  std::int64_t trials() const { return counted_.trials; }
  std::int64_t failures() const { return counted_.trials - counted_.outcomes.zero_count; }

  /// The sums of the trials added so far, for files.
  statistics::State state() const;
  /// Replaces the trials added so far by the trials that these sums (state()) describe.
  /// @param moves number of moves of each trial
  /// @throws Failure (bad_data) if the sums are impossible for a point of this kind.
  void restore(std::span<const std::int64_t> whole, std::span<const double> real, std::int64_t moves);

  /// The statistics of the trials added so far.
  /// @throws Failure (bad_input) for a confidence outside (0, 1).
  PointSummary statistics(const StatisticsOptions& options = {}) const;

 private:
  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive);
  bool is_valid(std::int64_t moves) const;
  bool has_valid_counts(std::int64_t moves) const;
  bool has_valid_jerks() const;
  bool has_valid_machines() const;
  bool has_valid_groups() const;
  void add_level_accumulators();
  void add_moves(std::span<const trial::MoveOutcome> moves);
  void add_level(std::size_t level, std::span<const trial::MoveOutcome> move);
  void add_to_groups(std::span<const trial::MoveOutcome> moves);
  void add_to_machine(std::span<const trial::MoveOutcome> moves);
  void add_trial_settling_times(const MovesOfTrials& some);
  void add_jerks(const trial::MoveOutcome& move, std::span<const trial::Jerk> jerks);
  std::vector<LevelStatistics> level_statistics(const StatisticsOptions& options) const;
  statistics::SuccessClaim claim(const PointSummary& point, const StatisticsOptions& options) const;

  MoveKind kind_;
  std::int64_t first_trial_;  ///< index of the first trial
  std::int64_t measured_{0};  ///< trials whose measures are added
  const layout::MeasureTable* table_;
  PointCounts counted_;
  std::vector<MeasureAccumulator> measures_;             ///< [row of the table]
  std::vector<std::vector<MeasureAccumulator>> levels_;  ///< [move][row of the table]
  std::vector<std::int64_t> lost_in_levels_;             ///< [move] trials whose motion was lost
  statistics::ByCluster<statistics::MachineTrials> machines_;
  std::vector<CellCounts> goals_;                   ///< [goal]
  std::vector<CellCounts> for_the_load_;            ///< [goal] counts for MoveKind::for_the_load
  std::vector<GoalSettling> goal_settling_;         ///< [goal] Settling times of the moves that it judges.
  GroupTrials groups_;                              ///< Trials of groups, if MoveKind::counts_trials().
  statistics::TrialClusters trial_settling_times_;  ///< Arrival time of each trial's slowest move, s.
  std::int64_t jerks_{0};
  statistics::Histogram<double> jerk_intervals_;
  JerkSlowing jerk_slowing_;  ///< counts only; `proportion` and `tau` are not set
  statistics::RankTrend interval_trend_;
  std::int64_t one_count_jerks_{0};
  std::vector<double> values_;  ///< Values of the current trial or move.
};

}  // namespace zerocount::measures
