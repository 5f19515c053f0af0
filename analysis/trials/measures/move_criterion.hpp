#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "analysis/trials/measures/move_counts.hpp"
#include "core/text/relation.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/features.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/measure_table.hpp"

/// The criterion by which single moves are counted: the part of a claim that can be decided for one move.
namespace zerocount::measures {

/// A limit that a measure of the move must keep.
struct MeasureLimit {
  /// The limited measure: a row of layout::measure_table(), a table that outlives this object.
  const layout::Measure* measure{nullptr};
  bool of_magnitude{true};  ///< The limit is on the magnitude of the measure, not on the signed value.
  text::Limit limit{};      ///< Limit in the unit of the measure.
};

/// Whether the move keeps the limit. A measure with nothing to measure keeps every limit, and an event that
/// never came is beyond every limit (ranked_value()).
bool keeps(const trial::MoveOutcome& move, const MeasureLimit& limit);

/// The demand of a criterion on the end of a move.
enum class Settling : std::uint8_t {
  not_demanded,    ///< Only limits are demanded.
  at_zero_counts,  ///< The move must succeed: it must end at zero counts.
  in_band,         ///< The count error must stay within an error band for good, within the allowed time.
  in_tolerance     ///< The position error must stay within a tolerance for good, within the allowed time.
};

/// The criterion by which a move is counted: the move must settle, and it must keep all limits.
struct MoveCriterion {
  Settling settling{Settling::at_zero_counts};
  /// Settling::in_band: index of the error band in MoveOutcome::bands. Settling::in_tolerance: index of the
  /// tolerance in MoveOutcome::tolerance_settling_times. Otherwise not used.
  std::size_t slot{0};
  /// True: `slot` is an index in MoveOutcome::other_tolerance_settling_times, because the goal judges the
  /// mass whose encoder does not close the loop.
  bool of_other_mass{false};
  study::TimeLimit within{0.0};  ///< Time within which the error must stay in the band or tolerance.
  /// Numbers within the trial of the moves that are judged, rising; empty: all moves.
  std::vector<std::int64_t> on{};
  std::vector<MeasureLimit> limits{};
};

/// The criterion of a goal for moves of a study with these features; null if their outcomes lack its band,
/// tolerance or limits.
std::optional<MoveCriterion> move_criterion_of(const study::Goal& goal, const study::StudyFeatures& features);
/// [goal] Criteria of the study's goals; empty if the study has no goal.
std::vector<MoveCriterion> criteria_of_goals(const study::Study& study);
/// Criteria of the study's goals; if it has none, the single criterion that the move succeeds (ends at zero
/// counts).
std::vector<MoveCriterion> move_criteria_of(const study::Study& study);

/// Number of moves of a trial that the criterion judges.
/// @param moves number of moves of a trial
inline std::int64_t asked_moves(const MoveCriterion& criterion, std::int64_t moves) {
  return criterion.on.empty() ? moves : std::ssize(criterion.on);
}

/// Whether the criterion judges this move; some goals judge only certain moves of a trial.
inline bool asks(const MoveCriterion& criterion, const trial::MoveOutcome& move) {
  return criterion.on.empty() || std::ranges::binary_search(criterion.on, move.number);
}

/// Time that the criterion allows this move, s from the start of the move.
inline double allowed_time(const MoveCriterion& criterion, const trial::MoveOutcome& move) {
  return criterion.within.from_start(move.travel_time);
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

/// Settling time: time from which on the move stays within the band or tolerance of the criterion, s from the
/// start of the move. For other criteria: the arrival time. NaN if the move never settles.
inline double settling_time(const MoveCriterion& criterion, const trial::MoveOutcome& move) {
  switch (criterion.settling) {
    case Settling::in_band:
      return move.bands[criterion.slot].settling_time;
    case Settling::in_tolerance:
      return (criterion.of_other_mass ? move.other_tolerance_settling_times
                                      : move.tolerance_settling_times)[criterion.slot];
    case Settling::not_demanded:
    case Settling::at_zero_counts:
      break;
  }
  return move.arrival_time;
}

/// Whether the move meets the criterion.
/// @param move a move that the criterion judges
bool meets(const MoveCriterion& criterion, const trial::MoveOutcome& move);

/// Whether all moves of a trial that the criterion judges meet it; true if it judges none.
inline bool all_meet(const MoveCriterion& criterion, std::span<const trial::MoveOutcome> moves) {
  return std::ranges::all_of(moves, [&](const trial::MoveOutcome& move) {
    return !asks(criterion, move) || meets(criterion, move);
  });
}

/// Adds to `counts` the moves of a trial that the criterion judges.
/// @param trial index of the trial at the design point
/// @returns number of moves that meet the criterion
std::int64_t count_moves(CellCounts& counts, const MoveCriterion& criterion, std::int64_t trial,
                         std::span<const trial::MoveOutcome> moves);

}  // namespace zerocount::measures
