#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "analysis/measures/level_statistics.hpp"
#include "analysis/measures/outcome_counts.hpp"
#include "analysis/measures/undecided_moves.hpp"
#include "analysis/statistics/moments.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/quantile.hpp"
#include "analysis/statistics/rig_statistics.hpp"
#include "analysis/statistics/tolerance.hpp"
#include "analysis/statistics/trend.hpp"

/// What is reported of a design point. All bounds have the confidence of the summary. Every proportion and
/// mean names what it is a proportion or mean of: "of trials" is of all trials of the point, "of moves" of
/// all moves of all its trials. No trial is left out of either.
namespace zerocount {

/// The trials by one of their moves: all trials of the point have it.
struct MoveCounts {
  OutcomeCounts outcomes;
  std::int64_t arrived{0};
  std::int64_t stable{0};
  std::int64_t broke_away{0};
  std::int64_t saturated{0};
  std::int64_t stopped{0};  ///< ended in it or before it
};

/// Share of trials with bounds; NaN where there are none that could be a part of it.
struct RateWithBounds {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double value{unknown};
  ConfidenceInterval clopper_pearson{unknown, unknown};
  ConfidenceInterval wilson{unknown, unknown};
};

/// Settling time of moves, s. Quantiles are of all moves with a target: a move that never arrived is later
/// than any time, and a quantile or bound that falls among those is NaN, not reached within the hold.
struct SettlingStatistics {
  std::int64_t n{0};      ///< moves that arrived
  std::int64_t moves{0};  ///< moves with a target, whether they arrived or not
  double mean{std::numeric_limits<double>::quiet_NaN()};  ///< of the moves that arrived, like min and max
  double min{std::numeric_limits<double>::quiet_NaN()};
  double max{std::numeric_limits<double>::quiet_NaN()};
  Quantile p05, p25, median, p75, p95;  ///< of all moves, with order-statistic bounds
  ConfidenceInterval mean_bounds{std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::quiet_NaN()};  ///< NaN unless asked for
  /// Of the slowest move of a trial, with the contents of tolerance_contents; a move that never arrives is
  /// beyond every limit.
  std::array<ToleranceLimit, std::size(tolerance_contents)> tolerance{};
};

/// Distance from the target at the last sample of a move, |target − count|, counts.
struct FinalErrorStatistics {
  std::int64_t n{0};  ///< moves whose distance is known and whose motion was not lost
  double mean{std::numeric_limits<double>::quiet_NaN()};
  double max{std::numeric_limits<double>::quiet_NaN()};
  Quantile median, p95;  ///< with order-statistic bounds
};

/// The moves that oscillate and were not ended early, over the last half of their samples.
struct OscillationStatistics {
  std::int64_t n{0};                                                  ///< moves
  double amplitude_median{std::numeric_limits<double>::quiet_NaN()};  ///< counts
  double period_median{std::numeric_limits<double>::quiet_NaN()};     ///< of those that have one, s
};

/// Something that happens a number of times in a trial, over all its moves.
struct TimesPerTrial {
  std::int64_t trials{0};  ///< trials in which it happened
  std::int64_t total{0};   ///< times in all trials
  std::int64_t max{0};     ///< times in one trial

  void add(std::int64_t times) {
    trials += times > 0;
    total += times;
    max = std::max(max, times);
  }
};

/// Jerks of a trial, over all its moves; of trials, those without jerks or arrival (0 jerks) included.
struct JerkCountStatistics {
  std::int64_t n{0};  ///< trials
  double mean{std::numeric_limits<double>::quiet_NaN()};
  double sd{std::numeric_limits<double>::quiet_NaN()};
  double median{std::numeric_limits<double>::quiet_NaN()};
  double p95{std::numeric_limits<double>::quiet_NaN()};
  double max{std::numeric_limits<double>::quiet_NaN()};
  std::int64_t total{0};  ///< jerks of the point
  ConfidenceInterval mean_bounds{std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::quiet_NaN()};  ///< NaN unless asked for
};

/// Time between the onsets of successive jerks of a move, s.
struct JerkIntervalStatistics {
  std::int64_t n{0};  ///< intervals: jerks − 1 for each move with jerks
  double mean{std::numeric_limits<double>::quiet_NaN()};
  double median{std::numeric_limits<double>::quiet_NaN()};
};

/// Whether jerks slow down, as the paper's Fig. 8 shows: whether the intervals of a move grow in their order.
///
/// Judged for each move with 3 jerks or more by the Mann–Kendall statistic S of its intervals (rank_trend):
/// the move slows down if S > 0, speeds up if S < 0. Jerks at random times would make both equally frequent,
/// whatever the distribution of the intervals, and τ zero on average.
struct JerkSlowing {
  std::int64_t moves{0};                                        ///< moves with 3 jerks or more
  std::int64_t slowing{0};                                      ///< of them, S > 0
  std::int64_t quickening{0};                                   ///< of them, S < 0
  double proportion{std::numeric_limits<double>::quiet_NaN()};  ///< slowing / moves
  double tau{std::numeric_limits<double>::quiet_NaN()};  ///< Kendall's τ_a over the pairs of intervals within
                                                         ///< a move, all moves pooled
};

/// Everything that is reported of a design point.
struct PointSummary {
  double confidence{summary_confidence};  ///< of all bounds
  std::int64_t trials{0};
  std::int64_t moves{0};  ///< moves of all trials
  double hold{
      std::numeric_limits<double>::quiet_NaN()};  ///< of a move, s, in a summary; NaN where trials differ

  std::int64_t judged{0};           ///< trials with targets: all, or none in an open-loop study
  OutcomeCounts outcomes;           ///< trials by the worst of their moves
  std::vector<MoveCounts> by_move;  ///< [move]
  std::int64_t stable{0};           ///< trials all of whose moves were stable
  std::int64_t arrived{0};          ///< trials all of whose moves arrived
  std::int64_t broke_away{0};       ///< trials in which the hook slid during any move
  std::int64_t saturated{0};        ///< trials in which the DAC clipped during any move
  std::int64_t stopped{0};          ///< trials that were ended early, because a move had diverged
  RateWithBounds success_rate;      ///< zero_count / judged
  RateWithBounds stable_rate;       ///< stable / judged
  SuccessClaim claim;  ///< what zero_count of judged shows of all axes; none of an open-loop study
  RigStatistics rigs;  ///< how the rigs differ; of a study with rigs

  SettlingStatistics settling_time;
  SettlingStatistics final_settling_time;  ///< until zero for good; n: moves that ended at zero error
  JerkCountStatistics jerk_count;
  JerkIntervalStatistics jerk_interval;
  JerkSlowing jerk_slowing;
  std::int64_t jerks_agreeing{0};  ///< jerks in the direction of the sign of their move's holding torque
  double jerk_agreement{std::numeric_limits<double>::quiet_NaN()};        ///< jerks_agreeing / jerks
  double jerk_one_count_share{std::numeric_limits<double>::quiet_NaN()};  ///< jerks of magnitude 1 / jerks

  FinalErrorStatistics final_error;
  Moments zero_fraction;  ///< of the moves that arrived: samples at zero error since then, as a fraction
  OscillationStatistics oscillation;
  UndecidedMoves undecided;  ///< but for off_target moves nothing is known of them without the study
  Moments true_error;        ///< distance of moves with a target, |true_error|, counts
  Moments travel_time;       ///< of moves, s
  TimesPerTrial phase_changes;
  TimesPerTrial encoder_disagreement;   ///< samples
  std::vector<LevelStatistics> levels;  ///< [move] in an open-loop study, otherwise empty

  Moments overshoot;               ///< of moves with a target, counts
  Moments holding_torque;          ///< of moves, N m, signed
  Moments creep;                   ///< of moves, rad, signed
  Moments peak_torque;             ///< of moves, N m
  std::int64_t reversal_depth{0};  ///< largest of all moves
};

}  // namespace zerocount
