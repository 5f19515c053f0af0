#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/basis/statistics/clusters/machine_statistics.hpp"
#include "analysis/basis/statistics/clusters/tolerance.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/trials/measures/goal_settling.hpp"
#include "analysis/trials/measures/measure_statistics.hpp"
#include "analysis/trials/measures/undecided_moves.hpp"

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
  /// Number of torque levels of an open-loop study, which have no target and are not judged.
  std::int64_t open_loop{0};

  std::int64_t total() const;
  OutcomeCounts& operator+=(const OutcomeCounts& other);

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.zero_count, self.one_count, self.off_target, self.oscillating, self.nonfinite,
            self.open_loop);
  }
};

/// The counter for each outcome, in the order of the numbers that the outcomes have in files.
inline constexpr std::array outcome_counters{&OutcomeCounts::zero_count,  &OutcomeCounts::one_count,
                                             &OutcomeCounts::oscillating, &OutcomeCounts::nonfinite,
                                             &OutcomeCounts::open_loop,   &OutcomeCounts::off_target};

/// The member of OutcomeCounts that counts an outcome.
/// @throws Failure (bad_data) for a value that is not an outcome: the file is damaged
std::int64_t OutcomeCounts::*counter_of(trial::Outcome outcome);

/// Statistics of the time between the onsets of successive jerks of a move, s.
struct JerkIntervalStatistics {
  std::int64_t n{0};  ///< Number of intervals: (number of jerks − 1), summed over the moves with jerks.
  double mean{statistics::unknown};
  double median{statistics::unknown};
};

/// Counts that show whether jerks slow down, as the paper's Fig. 8 shows: whether the intervals between the
/// jerks of a move grow in their order.
///
/// Each move with 3 jerks or more is judged by the Mann–Kendall statistic S of its intervals (rank_trend):
/// the move slows down if S > 0, speeds up if S < 0. Jerks at random times would make both equally frequent,
/// whatever the distribution of the intervals, and τ zero on average.
struct JerkSlowing {
  std::int64_t moves{0};       ///< Number of moves with 3 jerks or more, which are judged.
  std::int64_t slowing{0};     ///< Number of moves whose jerks slow down: 3 jerks or more and S > 0.
  std::int64_t quickening{0};  ///< Number of moves whose jerks speed up: 3 jerks or more and S < 0.
  /// Proportion of these moves whose jerks slow down: slowing / moves.
  double proportion{statistics::unknown};
  /// Kendall's τ_a over the pairs of intervals within a move, pooled over all moves; positive if jerks slow
  /// down.
  double tau{statistics::unknown};

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.moves, self.slowing, self.quickening);
  }
};

/// Statistics of one torque level of an open-loop study over the trials of a point. All values are taken at
/// the end of the level. Trials whose motion was lost at this level or before are only counted.
struct LevelStatistics : StatisticsOfMeasures {
  /// Number of trials whose motion was lost (became non-finite) at this level or before.
  std::int64_t nonfinite{0};
};

/// Counts of the trials, moves and jerks of a design point, without bounds.
struct PointCounts {
  std::int64_t trials{0};
  std::int64_t moves{0};  ///< Number of moves of all trials.
  /// Number of trials with each outcome; the outcome of a trial is that of its worst move.
  OutcomeCounts outcomes;
  /// [move] Number of trials in which this move has each outcome; every trial has the move.
  std::vector<OutcomeCounts> by_move;
  /// Number of jerks whose direction is the sign of their move's holding torque.
  std::int64_t jerks_agreeing{0};

  PointCounts& operator+=(const PointCounts& other);

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.trials, self.moves, self.outcomes, self.by_move, self.jerks_agreeing);
  }
};

/// Counts of the trials of a design point by machine, world and setting; a whole trial is counted like one
/// move.
struct GroupTrials {
  CellCounts succeeded;  ///< Counts of successful trials: all moves ended at zero error.
  /// Counts of trials that meet the goals: all moves meet the goals that judge them. Empty without a goal.
  CellCounts meeting;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.succeeded, self.meeting);
  }
};

/// All statistics of a design point.
struct PointSummary : StatisticsOfMeasures, PointCounts {
  /// Time for which the target of a move is held, s; NaN if it differs between trials. Set in summaries only.
  double hold{statistics::unknown};

  /// Number of trials whose moves have targets: all trials, or 0 in an open-loop study.
  std::int64_t judged{0};
  /// Tolerance statement about the success of all machines, from the trials that succeeded (zero_count) among
  /// `judged`; none for an open loop.
  statistics::SuccessClaim claim;
  /// Statistics of the differences between machines, in a study with machines.
  statistics::MachineStatistics machines;
  /// Upper tolerance limits of a trial's settling time, which is the arrival time of its slowest move, s; one
  /// for each of statistics::tolerance_contents. A trial with a move that never arrives is above every limit.
  std::array<statistics::ToleranceLimit, std::size(statistics::tolerance_contents)> settles_within{};
  JerkIntervalStatistics jerk_interval;
  JerkSlowing jerk_slowing;
  /// Proportion of jerks whose direction is the sign of their move's holding torque: jerks_agreeing / jerks.
  double jerk_agreement{statistics::unknown};
  double jerk_one_count_share{statistics::unknown};  ///< Proportion of jerks with a magnitude of one count.
  /// Counts of the moves that ended off target and are neither stable nor shown unstable. If the study is not
  /// at hand, only `off_target` is known.
  UndecidedMoves undecided;
  std::vector<CellCounts> goals;  ///< [goal] Counts of the moves that meet the goal.
  /// [goal] counts of the moves in which the load meets the goal (MoveKind::for_the_load); empty if no goal
  /// is counted for the load.
  std::vector<CellCounts> for_the_load;
  /// [goal][setting, or 0 without settings] settling times of the moves that the goal judges. Empty for a
  /// goal on all moves of a study without settings: its times are then those of the measure of its band.
  std::vector<std::vector<SettlingTimes>> goal_settling;
  /// Counts of whole trials; null unless MoveKind::counts_trials() and the moves have targets.
  std::optional<GroupTrials> trials_of_groups;
  /// [torque level] Statistics of each level of an open-loop study; otherwise empty.
  std::vector<LevelStatistics> levels;

  /// Success rate: the proportion of trials all of whose moves ended at zero error, with its bounds.
  const RateWithBounds& success_rate() const { return of(&trial::MoveOutcome::outcome).rate; }
};

}  // namespace zerocount::measures
