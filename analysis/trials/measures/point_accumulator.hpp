#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/basis/statistics/change_point.hpp"
#include "analysis/basis/statistics/clusters/clustered_mean.hpp"
#include "analysis/basis/statistics/clusters/trial_clusters.hpp"
#include "analysis/basis/statistics/sums/histogram.hpp"
#include "analysis/basis/statistics/sums/state.hpp"
#include "analysis/trials/measures/goal_settling.hpp"
#include "analysis/trials/measures/measure_statistics.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/measures/point_statistics.hpp"
#include "core/trial/outcome.hpp"

namespace zerocount::measures {

/// The outcomes of the moves of successive trials of a design point.
struct MovesOfTrials {
  std::int64_t first_trial{0};  ///< Index at the design point of the first of these trials.
  std::size_t of_trial{1};      ///< Number of moves of each trial.
  std::span<const trial::MoveOutcome* const> moves;  ///< [trial][move], flattened: outcomes of the moves.

  std::int64_t trials() const { return std::ssize(moves) / static_cast<std::int64_t>(of_trial); }
};

/// Properties that all moves of a study share.
struct MoveKind {
  bool open_loop{false};  ///< True: the moves are torque levels of an open-loop study and have no targets.
  Shape shape{};
  std::vector<MoveCriterion> goals{};
  /// [goal] The same criterion applied to the load instead of the motor, if the goal has
  /// study::Goal::beside_load; otherwise null. The vector is empty if no goal has it.
  std::vector<std::optional<MoveCriterion>> for_the_load{};

  bool has_observed_counts{false};  ///< Whether the study is compared with counts observed on a real machine.

  /// Whether whole trials are counted in addition to their moves (PointSummary::trials_of_groups).
  bool counts_trials() const {
    return shape.worlds > 0 || shape.settings > 0 || (has_observed_counts && !goals.empty());
  }
};

/// The properties that all moves of this study share.
MoveKind move_kind(const study::Study& study);

/// Source of the random numbers for the resampling (bootstrap) of a design point's trials.
struct BootstrapDraws {
  std::uint64_t seed{0};    ///< Seed of the study.
  std::uint32_t stream{0};  ///< Number of the design point, which selects the stream of random numbers.
};

/// Options for the statistics of a design point.
struct StatisticsOptions {
  double confidence{statistics::summary_confidence};
  /// Random numbers of the bootstrap, which gives the bounds of means. Null: these bounds are not computed.
  std::optional<BootstrapDraws> bootstrap{};
  /// Whether the outcomes of the trials decided when the study stopped. The bounds of claims about all
  /// machines must then hold at any stopping time.
  bool stopped_by_outcomes{false};
};

/// Collects one measure of the trials of a design point and computes its statistics. The trials of one
/// machine and the moves of one trial are clusters: the bounds account for their correlation.
///
/// Measures that are summed over a trial, and measures with quantiles, are kept as histograms. The memory
/// grows with the number of distinct values, not with the number of trials.
class MeasureAccumulator {
 public:
  /// Creates an empty accumulator.
  /// @param measure must outlive this object
  /// @param reported the statistics of the measure that are reported at a design point, or at a torque level
  /// @param kind properties of the moves
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
  /// Whether the sums that were read from a file are possible for this measure.
  /// @param trials number of trials
  /// @param moves number of moves of each trial
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
  /// Whether values are kept by cluster of dependent values (trial or machine); otherwise only their moments
  /// are.
  bool in_clusters_;
  bool has_mean_bounds_;  ///< Whether bootstrap bounds of the mean are reported.
  bool counts_moves_;     ///< Whether the proportion of moves with the quality is reported.
  std::int64_t trials_{0};
  statistics::MomentSums moments_;
  statistics::TrialClusters clusters_;
  statistics::ClusterTotals totals_;
  /// [move] Number of trials in which this move has the quality; empty as long as there are no trials.
  std::vector<std::int64_t> by_move_;
  /// [machine] Number of trials on the machine; without machines all count as machine 0.
  statistics::ByCluster<> judged_;
  /// [machine] Number of trials on the machine that have the quality; indexed like judged_.
  statistics::ByCluster<> hits_;
  CellCounts of_moves_;         ///< Counts of the moves that have the quality; used only if counts_moves_.
  std::vector<double> values_;  ///< Values of the trials that are being added; working memory.
};

/// Collects the trials of one design point and computes its statistics. The trials of one machine and the
/// moves of one trial are clusters: the bounds account for their correlation.
///
/// The memory grows with the number of distinct settling times, jerk counts, jerk intervals and final errors
/// (with machines: of each machine), not with the number of trials. For one sample rate it is limited by the
/// samples of a move and the maximum error in counts.
class PointAccumulator {
 public:
  /// Creates an accumulator without trials.
  /// @param kind properties of the moves
  /// @param table the measures; must outlive this object
  /// @param first_trial index of the first trial that will be added
  explicit PointAccumulator(const MoveKind& kind = {},
                            const layout::MeasureTable& table = layout::measure_table(),
                            std::int64_t first_trial = 0);

  /// Adds a trial with its jerks in order of move and onset.
  /// @throws Failure (bad_data) if the trial has no move or another number of moves than earlier trials, if
  /// its jerks are out of order or their number differs from the outcome, or if its moves are not of the
  /// kind.
  void add(const trial::TrialOutcome& trial, std::span<const trial::Jerk> jerks);

  /// First part of add(), for many trials at once: adds the measures of their moves, column by column.
  /// add_counts() must then be called for each of these trials.
  /// @param moves [trial][move], flattened
  /// @param moves_of_trial number of moves of each trial
  void add_measures(std::span<const trial::MoveOutcome* const> moves, std::size_t moves_of_trial);
  /// Second part of add(), for one trial: adds everything except the measures.
  /// @param jerks jerks of the trial in order of move and onset
  void add_counts(std::span<const trial::MoveOutcome> moves, std::span<const trial::Jerk> jerks);

  /// Adds the trials of another accumulator for the same design point; they must follow the trials of this
  /// object. The statistics do not depend on how the trials of a point were divided.
  PointAccumulator& operator+=(const PointAccumulator& next);

  std::int64_t trials() const { return counted_.trials; }
  std::int64_t failures() const { return counted_.trials - counted_.outcomes.zero_count; }

  /// The sums of the trials added so far, in the form in which files store them.
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
  std::int64_t first_trial_;  ///< Index at the design point of the first trial.
  std::int64_t measured_{0};  ///< Number of trials whose measures have been added (add_measures()).
  const layout::MeasureTable* table_;
  PointCounts counted_;
  /// [row of the table] Accumulator of the measure, over all moves.
  std::vector<MeasureAccumulator> measures_;
  /// [torque level][row of the table] Accumulator of the measure at this level; empty unless the study is
  /// open-loop.
  std::vector<std::vector<MeasureAccumulator>> levels_;
  /// [torque level] Number of trials whose motion was lost (became non-finite) at this level or before.
  std::vector<std::int64_t> lost_in_levels_;
  statistics::ByCluster<statistics::MachineTrials> machines_;
  /// [goal] Counts of the moves that the goal judges and of those that meet it.
  std::vector<CellCounts> goals_;
  /// [goal] Counts of the moves in which the load meets the goal (MoveKind::for_the_load).
  std::vector<CellCounts> for_the_load_;
  std::vector<GoalSettling> goal_settling_;  ///< [goal] Settling times of the moves that the goal judges.
  GroupTrials groups_;  ///< Counts of whole trials; used only if MoveKind::counts_trials().
  /// Settling time of each trial: the arrival time of its slowest move, s.
  statistics::TrialClusters trial_settling_times_;
  std::int64_t jerks_{0};
  statistics::Histogram<double> jerk_intervals_;
  /// Counts of the moves whose jerks slow down or speed up; its members `proportion` and `tau` are not set.
  JerkSlowing jerk_slowing_;
  statistics::RankTrend interval_trend_;
  std::int64_t one_count_jerks_{0};
  std::vector<double> values_;  ///< Values of the trial or move that is being added; working memory.
};

}  // namespace zerocount::measures
