#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/measures/goal_counts.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::measures {

/// An event of a move: it misses what is asked of it, or a measure of it is beyond a limit.
struct MoveEvent {
  std::string text;  ///< "settling_time > 0.5"; empty: it misses the goal, or does not succeed
  std::vector<CountedGoal> goals{};  ///< used if text is empty
  layout::Measure measure{};         ///< used otherwise
  bool above{true};                  ///< the event is a value above the limit; otherwise below
  bool inclusive{false};             ///< the limit itself is the event too
  double limit{0.0};                 ///< in the measure's unit
};

/// The event that a move misses the goal of the study or, without a goal, that it does not succeed.
MoveEvent missed_question(const study::Study& study);

/// The event of a text such as "settling_time > 0.5" or "band_settling_time[1] >= 0.05".
/// @throws Failure (bad_input) unless it is MEASURE, one of > >= < <=, and a number
MoveEvent parse_event(const study::Study& study, std::string_view text);

/// Whether the event can be that of this move: a goal is about it, or the event is not of goals.
bool is_asked(const MoveEvent& event, const trial::MoveOutcome& move);

/// Whether the event is that of this move. A time that the move never reached is later than any limit; a
/// motion that was lost is above any limit.
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
