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

/// A limit of a goal: the magnitude of the measure is at most `largest`.
struct CountedLimit {
  const layout::Measure* measure{nullptr};  ///< a row of a table that stays (layout::measure_table())
  double largest{0.0};
};

/// What is asked of a move: to be within an error band, or a tolerance, for good in time and to keep the
/// limits; or to succeed (end at zero counts).
struct CountedGoal {
  std::optional<std::size_t> slot{};       ///< of the band, in MoveOutcome::bands
  study::TimeLimit within{0.0};            ///< of a band or a tolerance
  std::optional<std::size_t> tolerance{};  ///< in MoveOutcome::tolerance_settling_times. Neither: it succeeds
  bool of_other_mass{false};               ///< the tolerance is in other_tolerance_settling_times
  std::vector<std::int64_t> on{};          ///< the moves that are asked, rising; empty: all
  std::vector<CountedLimit> limits{};
};

/// The goal as moves with these features are counted; nothing where they lack its band, tolerance or limits.
std::optional<CountedGoal> counted_by(const study::Goal& goal, const study::StudyFeatures& features);
/// The goals of the study as they are counted, [goal]; empty without one.
std::vector<CountedGoal> counted_goals(const study::Study& study);
/// The goals of the study, or success where it has none.
std::vector<CountedGoal> asked_of_moves(const study::Study& study);

/// Number of moves of a trial that the goal asks. @param moves of a trial
inline std::int64_t asked_moves(const CountedGoal& goal, std::int64_t moves) {
  return goal.on.empty() ? moves : std::ssize(goal.on);
}

/// Whether the goal is about this move.
inline bool asks(const CountedGoal& goal, const trial::MoveOutcome& move) {
  return goal.on.empty() || std::ranges::binary_search(goal.on, move.number);
}

/// The time that a goal allows this move, s from its start.
inline double allowed_time(const CountedGoal& goal, const trial::MoveOutcome& move) {
  return goal.within.from_start(move.travel_time);
}

/// A time that is never reached is later than any other.
inline double lateness(double time) {
  return std::isnan(time) ? std::numeric_limits<double>::infinity() : time;
}

/// Whether a time is in time, both in s. A sample at the very end is, although k·T may be rounded up, and
/// although a manifest may write the allowed time with few digits: 0.016333333333 s for 49 samples at 3 kHz.
constexpr double rounding_of_times = 1.0 + 1e-9;
inline bool is_in_time(double time, double allowed) {
  return time <= allowed * rounding_of_times;  // not NaN
}

/// When the move is within the goal's band, or tolerance, for good, or has arrived (of success), s; NaN if
/// never.
inline double settling_time(const CountedGoal& goal, const trial::MoveOutcome& move) {
  if (goal.tolerance)
    return (goal.of_other_mass ? move.other_tolerance_settling_times
                               : move.tolerance_settling_times)[*goal.tolerance];
  return goal.slot ? move.bands[*goal.slot].settling_time : move.arrival_time;
}

/// Whether the move does what is asked. @param move that is asked
bool meets(const CountedGoal& goal, const trial::MoveOutcome& move);

/// Whether all moves that the goal asks meet it.
inline bool all_meet(const CountedGoal& goal, std::span<const trial::MoveOutcome> moves) {
  return std::ranges::all_of(
      moves, [&](const trial::MoveOutcome& move) { return !asks(goal, move) || meets(goal, move); });
}

/// Adds the moves of a trial that the goal asks. @returns how many meet it
std::int64_t count_moves(CellCounts& counts, const CountedGoal& goal, std::int64_t trial,
                         std::span<const trial::MoveOutcome> moves);

/// The settling times of the moves that one goal asks, beside the times that it allows them.
struct SettlingTimes {
  MeasureStatistics times;              ///< number of moves, their extremes, median and 95 % quantile, s
  double allowed{statistics::unknown};  ///< s from the start of a move, the longest of all
  double share{statistics::unknown};  ///< 95 % quantile of time / allowed time; infinite where never reached
};

/// Collects the settling times of the moves that one goal asks, under each condition. A goal on all moves of
/// a study without conditions that allows all the same time needs no times of its own: they are those of its
/// band (or tolerance), which is a measure of the study.
class GoalSettling {
 public:
  GoalSettling(const CountedGoal& goal, const Shape& shape);

  /// Adds the moves of a trial. @param trial its index at the design point
  void add(std::int64_t trial, const CountedGoal& goal, std::span<const trial::MoveOutcome> moves);
  /// Adds other trials, of the same goal.
  GoalSettling& operator+=(const GoalSettling& next);
  /// [condition, or 0 without conditions]; empty where it collects nothing.
  std::vector<SettlingTimes> statistics(double confidence) const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    for (auto& times : self.times_) archive(times);
    for (auto& shares : self.shares_) archive(shares);
    for (auto& allowed : self.allowed_) archive(allowed);
  }
  /// Whether restored times can be those of so many moves.
  bool is_valid(std::int64_t moves) const;

 private:
  std::int64_t machines_;
  study::TimeLimit within_;
  std::vector<double> values_{};                     ///< of the current trial
  std::vector<statistics::TrialClusters> times_{};   ///< [condition]
  std::vector<statistics::TrialClusters> shares_{};  ///< [condition] of moves with times of their own
  std::vector<double> allowed_{};                    ///< [condition] the longest, s, likewise
};

/// An event of a move: it misses what is asked of it, or a measure of it is beyond a limit.
struct MoveEvent {
  std::string text;                  ///< "arrival_time > 0.5"; empty: it misses the goal, or does not succeed
  std::vector<CountedGoal> goals{};  ///< used if text is empty
  layout::Measure measure{};         ///< used otherwise
  text::Sign sign{text::Sign::above};  ///< how values that are the event lie to the limit; never equal
  double limit{0.0};                   ///< in the measure's unit
};

/// The event that a move misses the goal of the study or, without a goal, that it does not succeed.
MoveEvent missed_question(const study::Study& study);

/// The event of a text such as "arrival_time > 0.5" or "band_settling_time[1] >= 0.05".
/// @throws Failure (bad_input) unless it is MEASURE, one of > >= < <= (or ≥, ≤), and a number
MoveEvent parse_event(const study::Study& study, std::string_view text);

/// Whether the event can be that of this move: a goal is about it, or the event is not of goals.
bool is_asked(const MoveEvent& event, const trial::MoveOutcome& move);

/// Whether the move shows the event. A value that is missing counts as ranked_value() says: an event that
/// never came is worse than any limit, and nothing to measure is no event.
bool happens(const MoveEvent& event, const trial::MoveOutcome& move);

/// The continuous scores of a move. Each is larger the nearer a move is to some kind of failure.
enum class MoveScore {
  event,        ///< settling time in the goal's band, or arrival, s; or the measure, with the event's sign
  peak_torque,  ///< largest |torque|, N m: towards the range of the converter, and towards breakaway
  final_error,  ///< |true error| at the end, counts: towards the edge of a band
  restlessness  ///< part of the samples after arrival at which the error is not 0
};

/// Every score, the most direct one first.
inline constexpr std::array move_scores{MoveScore::event, MoveScore::peak_torque, MoveScore::final_error,
                                        MoveScore::restlessness};

/// "settling time in the band", "time until arrival", or the name of the event's measure; "largest torque" …
std::string name_of(MoveScore score, const MoveEvent& event);

/// The score of a move; NaN where it has none.
double score_of(MoveScore score, const MoveEvent& event, const trial::MoveOutcome& move);

}  // namespace zerocount::measures
