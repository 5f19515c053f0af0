#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/measures/goal_counts.hpp"
#include "analysis/measures/measure_statistics.hpp"
#include "analysis/measures/undecided_moves.hpp"
#include "analysis/statistics/clusters/machine_statistics.hpp"
#include "analysis/statistics/clusters/tolerance.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/unknown.hpp"

/// Statistics of a design point. All bounds have the confidence of the summary. Every proportion and mean
/// names its denominator: "of trials" is all trials of the point, "of moves" all moves of all its trials.
namespace zerocount::measures {

/// Number of trials (or moves) with each outcome.
struct OutcomeCounts {
  std::int64_t zero_count{0};
  std::int64_t one_count{0};
  std::int64_t off_target{0};
  std::int64_t oscillating{0};
  std::int64_t nonfinite{0};
  std::int64_t open_loop{0};  ///< torque levels, which are not judged

  std::int64_t total() const;
  OutcomeCounts& operator+=(const OutcomeCounts& other);

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.zero_count, self.one_count, self.off_target, self.oscillating, self.nonfinite,
            self.open_loop);
  }
};

/// The counter of each outcome, indexed by the number that the outcome has in files.
inline constexpr std::array outcome_counters{&OutcomeCounts::zero_count,  &OutcomeCounts::one_count,
                                             &OutcomeCounts::oscillating, &OutcomeCounts::nonfinite,
                                             &OutcomeCounts::open_loop,   &OutcomeCounts::off_target};

/// The counter of an outcome.
/// @throws Failure (bad_data) for a value that is not an outcome: the file is damaged.
std::int64_t OutcomeCounts::*counter_of(trial::Outcome outcome);

/// Time between the onsets of successive jerks of a move, s.
struct JerkIntervalStatistics {
  std::int64_t n{0};  ///< intervals: jerks − 1 for each move with jerks
  double mean{statistics::unknown};
  double median{statistics::unknown};
};

/// Whether jerks slow down, as the paper's Fig. 8 shows: whether the intervals of a move grow in their order.
///
/// Judged for each move with 3 jerks or more by the Mann–Kendall statistic S of its intervals (rank_trend):
/// the move slows down if S > 0, speeds up if S < 0. Jerks at random times would make both equally frequent,
/// whatever the distribution of the intervals, and τ zero on average.
struct JerkSlowing {
  std::int64_t moves{0};                   ///< moves with 3 jerks or more
  std::int64_t slowing{0};                 ///< moves with 3 jerks or more and S > 0
  std::int64_t quickening{0};              ///< moves with 3 jerks or more and S < 0
  double proportion{statistics::unknown};  ///< slowing / moves
  double tau{statistics::unknown};         ///< Kendall's τ_a over the pairs of intervals within
                                           ///< a move, all moves pooled

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.moves, self.slowing, self.quickening);
  }
};

/// Statistics of one torque level of an open-loop study over the trials of a point. All values are taken at
/// the end of the level. Trials whose motion was lost at this level or before are only counted.
struct LevelStatistics : StatisticsOfMeasures {
  std::int64_t nonfinite{0};  ///< trials whose motion was lost
};

/// Plain counts of the trials of a design point.
struct PointCounts {
  std::int64_t trials{0};
  std::int64_t moves{0};               ///< moves of all trials
  OutcomeCounts outcomes;              ///< trials by the worst of their moves
  std::vector<OutcomeCounts> by_move;  ///< [move] trials by the outcome of this move; every trial has it
  std::int64_t jerks_agreeing{0};      ///< jerks whose direction is the sign of their move's holding torque

  PointCounts& operator+=(const PointCounts& other);

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.trials, self.moves, self.outcomes, self.by_move, self.jerks_agreeing);
  }
};

/// Counts of the trials of a design point; each trial counts like one move.
struct GroupTrials {
  CellCounts succeeded;  ///< Met: trials all of whose moves ended at zero error.
  /// Met: trials all of whose moves meet the goals that judge them; empty without a goal.
  CellCounts meeting;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.succeeded, self.meeting);
  }
};

/// All statistics of a design point.
struct PointSummary : StatisticsOfMeasures, PointCounts {
  double hold{statistics::unknown};  ///< Hold of a move, s; set in summaries only. NaN if trials differ.

  std::int64_t judged{0};                  ///< trials with targets: all, or none in an open-loop study
  statistics::SuccessClaim claim;          ///< Claim from zero_count of judged trials; none for an open loop.
  statistics::MachineStatistics machines;  ///< Differences between machines, in a study with machines.
  /// Upper tolerance limits of a trial's settling time, which is the arrival time of its slowest move, for
  /// the contents statistics::tolerance_contents. A trial with a move that never arrives is above every
  /// limit.
  std::array<statistics::ToleranceLimit, std::size(statistics::tolerance_contents)> settles_within{};
  JerkIntervalStatistics jerk_interval;
  JerkSlowing jerk_slowing;
  double jerk_agreement{statistics::unknown};        ///< jerks_agreeing / jerks
  double jerk_one_count_share{statistics::unknown};  ///< jerks of magnitude 1 / jerks
  UndecidedMoves undecided;       ///< Undecided moves; without the study only off_target is known.
  std::vector<CellCounts> goals;  ///< [goal] counts of the moves that meet the goal
  /// [goal] counts of the moves in which the load meets the goal (MoveKind::for_the_load); empty if no goal
  /// is counted for the load.
  std::vector<CellCounts> for_the_load;
  /// [goal][setting, or 0 without settings] settling times of the moves that the goal judges. Empty for a
  /// goal on all moves of a study without settings: its times are then those of the measure of its band.
  std::vector<std::vector<SettlingTimes>> goal_settling;
  /// Counts of trials. Empty unless MoveKind::counts_trials() and the moves have targets.
  std::optional<GroupTrials> trials_of_groups;
  std::vector<LevelStatistics> levels;  ///< [move] in an open-loop study, otherwise empty

  /// The proportion of trials all of whose moves ended at zero error.
  const RateWithBounds& success_rate() const { return of(&trial::MoveOutcome::outcome).rate; }
};

}  // namespace zerocount::measures
