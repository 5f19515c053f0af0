#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/measures/measure_statistics.hpp"
#include "analysis/measures/move_counts.hpp"
#include "analysis/statistics/clusters/trial_clusters.hpp"
#include "analysis/text/text.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/features.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::measures {

/// A limit of a goal: the magnitude of the measure must be at most `largest`.
struct CountedLimit {
  const layout::Measure* measure{nullptr};  ///< Row of layout::measure_table(), a table that outlives this.
  double largest{0.0};
};

/// The criterion by which a move is counted: either to settle within an error band, or a tolerance, for good
/// in time and to keep the limits; or, without band and tolerance, to succeed (end at zero counts).
struct CountedGoal {
  std::optional<std::size_t> slot{};       ///< Index of the band in MoveOutcome::bands.
  study::TimeLimit within{0.0};            ///< Time allowed to settle within the band or tolerance.
  std::optional<std::size_t> tolerance{};  ///< Index in MoveOutcome::tolerance_settling_times.
  bool of_other_mass{false};               ///< `tolerance` is an index in other_tolerance_settling_times.
  std::vector<std::int64_t> on{};          ///< Numbers of the moves that are judged, rising; empty: all.
  std::vector<CountedLimit> limits{};
};

/// The criterion of the goal for moves with these features; empty if they lack its band, tolerance or limits.
std::optional<CountedGoal> counted_by(const study::Goal& goal, const study::StudyFeatures& features);
/// [goal] the criteria of the study's goals; empty without a goal.
std::vector<CountedGoal> counted_goals(const study::Study& study);
/// The criteria of the study's goals; if it has none, the single criterion success.
std::vector<CountedGoal> asked_of_moves(const study::Study& study);

/// Number of moves of a trial that the goal judges. @param moves number of moves of a trial
inline std::int64_t asked_moves(const CountedGoal& goal, std::int64_t moves) {
  return goal.on.empty() ? moves : std::ssize(goal.on);
}

/// Whether the goal judges this move.
inline bool asks(const CountedGoal& goal, const trial::MoveOutcome& move) {
  return goal.on.empty() || std::ranges::binary_search(goal.on, move.number);
}

/// Time that the goal allows this move, s from the start of the move.
inline double allowed_time(const CountedGoal& goal, const trial::MoveOutcome& move) {
  return goal.within.from_start(move.travel_time);
}

/// The time as a rank: NaN, a time never reached, becomes infinity.
inline double lateness(double time) {
  return std::isnan(time) ? std::numeric_limits<double>::infinity() : time;
}

/// Relative tolerance of is_in_time(). A sample exactly at the allowed time must count, although k·T may be
/// rounded up and a manifest may give the time with few digits: 0.016333333333 s for 49 samples at 3 kHz.
constexpr double rounding_of_times = 1.0 + 1e-9;
/// Whether `time` is at most `allowed`, up to rounding; both in s. False if `time` is NaN.
inline bool is_in_time(double time, double allowed) {
  return time <= allowed * rounding_of_times;  // not NaN
}

/// Time from which on the move stays within the goal's band or tolerance, s. For success: the arrival time.
/// NaN if never.
inline double settling_time(const CountedGoal& goal, const trial::MoveOutcome& move) {
  if (goal.tolerance)
    return (goal.of_other_mass ? move.other_tolerance_settling_times
                               : move.tolerance_settling_times)[*goal.tolerance];
  return goal.slot ? move.bands[*goal.slot].settling_time : move.arrival_time;
}

/// Whether the move meets the criterion. @param move a move that the goal judges
bool meets(const CountedGoal& goal, const trial::MoveOutcome& move);

/// Whether all moves that the goal judges meet it.
inline bool all_meet(const CountedGoal& goal, std::span<const trial::MoveOutcome> moves) {
  return std::ranges::all_of(
      moves, [&](const trial::MoveOutcome& move) { return !asks(goal, move) || meets(goal, move); });
}

/// Adds the moves of a trial that the goal judges. @returns number of moves that meet the goal
std::int64_t count_moves(CellCounts& counts, const CountedGoal& goal, std::int64_t trial,
                         std::span<const trial::MoveOutcome> moves);

/// Settling times of the moves that one goal judges, compared with the times allowed.
struct SettlingTimes {
  MeasureStatistics times;              ///< number of moves, their extremes, median and 95 % quantile, s
  double allowed{statistics::unknown};  ///< Longest time allowed to a move, s from its start.
  /// 95 % quantile of settling time / allowed time; infinite if it is never reached.
  double time_ratio{statistics::unknown};
};

/// Collects the settling times of the moves that one goal judges, in each setting. Nothing is collected
/// for a goal on all moves of a study without settings that allows all moves the same time: its times are
/// then a measure of the study, the settling time of its band or tolerance.
class GoalSettling {
 public:
  GoalSettling(const CountedGoal& goal, const Shape& shape);

  /// Adds the moves of a trial. @param trial its index at the design point
  void add(std::int64_t trial, const CountedGoal& goal, std::span<const trial::MoveOutcome> moves);
  /// Adds the trials of another accumulator for the same goal.
  GoalSettling& operator+=(const GoalSettling& next);
  /// [setting, or 0 without settings] the statistics; empty if nothing is collected.
  std::vector<SettlingTimes> statistics(double confidence) const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    for (auto& times : self.times_) archive(times);
    for (auto& ratios : self.time_ratios_) archive(ratios);
    for (auto& allowed : self.allowed_) archive(allowed);
  }
  /// Whether the restored times are possible for this number of moves.
  bool is_valid(std::int64_t moves) const;

 private:
  std::int64_t machines_;
  study::TimeLimit within_;
  std::vector<double> values_{};                    ///< Values of the current trial.
  std::vector<statistics::TrialClusters> times_{};  ///< [setting] settling times
  /// [setting] settling time / allowed time; empty if all moves are allowed the same time.
  std::vector<statistics::TrialClusters> time_ratios_{};
  /// [setting] longest allowed time, s; empty if all moves are allowed the same time.
  std::vector<double> allowed_{};
};

/// An event that a move may show: it misses the question of the study, or one of its measures is beyond a
/// limit.
struct MoveEvent {
  std::string text;  ///< "arrival_time > 0.5"; empty: the move misses the goal, or does not succeed
  std::vector<CountedGoal> goals{};    ///< used if text is empty
  layout::Measure measure{};           ///< used otherwise
  text::Sign sign{text::Sign::above};  ///< Relation of the value to the limit at the event; never equal.
  double limit{0.0};                   ///< Limit, in the measure's unit.
};

/// The event that a move misses the goal of the study or, without a goal, that it does not succeed.
MoveEvent missed_question(const study::Study& study);

/// Parses the text of an event, such as "arrival_time > 0.5" or "band_settling_time[1] >= 0.05".
/// @throws Failure (bad_input) unless it is MEASURE, one of > >= < <= (or ≥, ≤), and a number
MoveEvent parse_event(const study::Study& study, std::string_view text);

/// Whether the move can show the event: a goal judges the move, or the event is about a measure.
bool is_asked(const MoveEvent& event, const trial::MoveOutcome& move);

/// Whether the move shows the event. ranked_value() decides about missing values: a time never reached is
/// beyond every limit, and a move with nothing to measure does not show the event.
bool happens(const MoveEvent& event, const trial::MoveOutcome& move);

/// Continuous scores of a move. A larger score means that the move is nearer to some kind of failure.
enum class MoveScore {
  event,        ///< Settling time in the goal's band, or arrival time, s; or the event's measure, signed.
  peak_torque,  ///< Largest |torque|, N m: distance to the converter's range and to breakaway.
  final_error,  ///< |true error| at the end, counts: distance to the edge of a band.
  restlessness  ///< Proportion of the samples after arrival at which the error is not 0.
};

/// All scores, the most direct one first.
inline constexpr std::array move_scores{MoveScore::event, MoveScore::peak_torque, MoveScore::final_error,
                                        MoveScore::restlessness};

/// Name of a score. MoveScore::event: "settling time in the band", "time until arrival", or the name of the
/// event's measure. Other scores: "largest torque" …
std::string name_of(MoveScore score, const MoveEvent& event);

/// The score of a move; NaN if the move has none.
double score_of(MoveScore score, const MoveEvent& event, const trial::MoveOutcome& move);

}  // namespace zerocount::measures
