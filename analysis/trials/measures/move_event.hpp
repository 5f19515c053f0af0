#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/trials/measures/move_criterion.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"

/// Events whose probability `rare` estimates, and the scores of a move that lead its search to them.
namespace zerocount::measures {

/// An event that a move may show: it misses one of these criteria.
struct MoveEvent {
  /// Text of an event about a measure, as the user wrote it: "arrival_time > 0.5". Empty: the event is that
  /// the move misses a goal of the study or, without goals, does not succeed.
  std::string text{};
  /// Criteria of which the move misses at least one. For an event about a measure it is one criterion with
  /// one limit, the negation of the event: "arrival_time ≤ 0.5".
  std::vector<MoveCriterion> criteria{MoveCriterion{}};

  bool is_about_measure() const { return !text.empty(); }
};

/// The event that a move misses a goal of the study or, without a goal, that it does not end at zero counts.
MoveEvent missed_criteria(const study::Study& study);

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
  /// tolerance it is the settling time in it, s. With several goals, or if the allowed time counts from the
  /// end
  /// of the profile, it is the largest of settling time divided by allowed time over the goals.
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
