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

/// A limit of a goal on a measure of the move: the magnitude of the measure must be at most `largest`.
struct CountedLimit {
  /// The limited measure: a row of layout::measure_table(), a table that outlives this object.
  const layout::Measure* measure{nullptr};
  double largest{0.0};
};

/// The criterion of a goal by which a move is counted. Either the move must settle within an error band, or
/// within a tolerance, for good within the allowed time and keep the limits; or, without band and tolerance,
/// it must succeed (end at zero counts).
struct CountedGoal {
  /// Index of the goal's error band in MoveOutcome::bands; null if the goal has none.
  std::optional<std::size_t> slot{};
  study::TimeLimit within{0.0};  ///< Time within which the error must stay in the band or tolerance.
  /// Index of the goal's tolerance in MoveOutcome::tolerance_settling_times; null if the goal has none.
  std::optional<std::size_t> tolerance{};
  /// True: `tolerance` is an index in MoveOutcome::other_tolerance_settling_times, because the goal judges
  /// the mass whose encoder does not close the loop.
  bool of_other_mass{false};
  /// Numbers within the trial of the moves that the goal judges, rising; empty: all moves.
  std::vector<std::int64_t> on{};
  std::vector<CountedLimit> limits{};
};

/// The criterion of a goal for moves of a study with these features; null if their outcomes lack its band,
/// tolerance or limits.
std::optional<CountedGoal> counted_by(const study::Goal& goal, const study::StudyFeatures& features);
/// [goal] Criteria of the study's goals; empty if the study has no goal.
std::vector<CountedGoal> counted_goals(const study::Study& study);
/// Criteria of the study's goals; if it has none, the single criterion that the move succeeds (ends at zero
/// counts).
std::vector<CountedGoal> asked_of_moves(const study::Study& study);

/// Number of moves of a trial that the goal judges.
/// @param moves number of moves of a trial
inline std::int64_t asked_moves(const CountedGoal& goal, std::int64_t moves) {
  return goal.on.empty() ? moves : std::ssize(goal.on);
}

/// Whether the goal judges this move; some goals judge only certain moves of a trial.
inline bool asks(const CountedGoal& goal, const trial::MoveOutcome& move) {
  return goal.on.empty() || std::ranges::binary_search(goal.on, move.number);
}

/// Time that the goal allows this move, s from the start of the move.
inline double allowed_time(const CountedGoal& goal, const trial::MoveOutcome& move) {
  return goal.within.from_start(move.travel_time);
}

/// Converts a settling time to a number by which moves can be ranked: NaN, a time never reached, becomes
/// infinity.
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

/// Settling time: time from which on the move stays within the goal's band or tolerance, s from the start of
/// the move. For the criterion of success: the arrival time. NaN if the move never settles.
inline double settling_time(const CountedGoal& goal, const trial::MoveOutcome& move) {
  if (goal.tolerance)
    return (goal.of_other_mass ? move.other_tolerance_settling_times
                               : move.tolerance_settling_times)[*goal.tolerance];
  return goal.slot ? move.bands[*goal.slot].settling_time : move.arrival_time;
}

/// Whether the move meets the criterion of the goal.
/// @param move a move that the goal judges
bool meets(const CountedGoal& goal, const trial::MoveOutcome& move);

/// Whether all moves of a trial that the goal judges meet it; true if it judges none.
inline bool all_meet(const CountedGoal& goal, std::span<const trial::MoveOutcome> moves) {
  return std::ranges::all_of(
      moves, [&](const trial::MoveOutcome& move) { return !asks(goal, move) || meets(goal, move); });
}

/// Adds to `counts` the moves of a trial that the goal judges.
/// @param trial index of the trial at the design point
/// @returns number of moves that meet the goal
std::int64_t count_moves(CellCounts& counts, const CountedGoal& goal, std::int64_t trial,
                         std::span<const trial::MoveOutcome> moves);

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
  GoalSettling(const CountedGoal& goal, const Shape& shape);

  /// Adds the settling times of a trial.
  /// @param trial index of the trial at the design point
  /// @param goal the criterion of the goal
  void add(std::int64_t trial, const CountedGoal& goal, std::span<const trial::MoveOutcome> moves);
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

/// An event that a move may show: it misses the goals of the study, or one of its measures is beyond a limit.
struct MoveEvent {
  /// Text of an event about a measure: "arrival_time > 0.5". Empty: the event is that the move misses a goal
  /// or, without goals, does not succeed.
  std::string text;
  std::vector<CountedGoal> goals{};  ///< Criteria of the goals, used if `text` is empty.
  layout::Measure measure{};         ///< The measure, used if `text` is not empty.
  /// For an event about a measure: the relation >, ≥, < or ≤ between its value and the limit.
  text::Sign sign{text::Sign::above};
  double limit{0.0};  ///< Limit of the measure, in its unit.
};

/// The event that a move misses a goal of the study or, without a goal, that it does not end at zero counts.
MoveEvent missed_question(const study::Study& study);

/// Parses the text of an event about a measure, such as "arrival_time > 0.5" or "band_settling_time[1] >=
/// 0.05".
/// @throws Failure (bad_input) unless it is the name of a measure of the study, one of > >= < <= (or ≥, ≤),
/// and a number
MoveEvent parse_event(const study::Study& study, std::string_view text);

/// Whether the move can show the event at all: the event is about a measure, or a goal judges the move.
bool is_asked(const MoveEvent& event, const trial::MoveOutcome& move);

/// Whether the move shows the event. Missing values are treated as in ranked_value(): a time never reached is
/// beyond every limit, and a move with nothing to measure does not show the event.
bool happens(const MoveEvent& event, const trial::MoveOutcome& move);

/// Continuous scores of a move, which show how near it is to a failure. A larger score means nearer to some
/// kind of failure.
enum class MoveScore {
  /// Nearness to the event itself. For an event about a measure it is the measure, with the sign that makes
  /// larger values nearer to the event. Without a goal it is the arrival time, s. With one goal about a band
  /// or
  /// tolerance it is the settling time in it, s; with several goals, or goals that start after the profile,
  /// it
  /// is the largest of settling time / allowed time over the goals.
  event,
  /// Largest |torque|, N m: shows how near the move is to the converter's limit and to breakaway.
  peak_torque,
  final_error,  ///< |true error| at the end of the move, counts: shows how near it is to the edge of a band.
  /// Proportion of the samples after arrival at which the error is not 0: shows how restless the move is.
  restlessness
};

/// All scores of a move, the one most directly related to the event first.
inline constexpr std::array move_scores{MoveScore::event, MoveScore::peak_torque, MoveScore::final_error,
                                        MoveScore::restlessness};

/// Name of a score for the reader. MoveScore::event: "settling time in the band", "time until arrival", or
/// the name of the event's measure. Other scores: "largest torque" …
std::string name_of(MoveScore score, const MoveEvent& event);

/// The value of a score for a move; NaN if the move has none.
double score_of(MoveScore score, const MoveEvent& event, const trial::MoveOutcome& move);

}  // namespace zerocount::measures
