#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/measures/goal_counts.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::summary {

/// Of the values of some moves, of which 95 % are at most `p95`; NaN without values.
struct UpperValues {
  double p95{std::numeric_limits<double>::quiet_NaN()};
  double max{std::numeric_limits<double>::quiet_NaN()};
};

/// The torque decided while moves are at rest (MoveOutcome::rest_torque_power), over these moves.
struct RestTorque {
  double rms{0.0};       ///< root of the mean of its mean square, N m
  double changes{0.0};   ///< likewise of its changes from sample to sample, N m
  double of_range{0.0};  ///< the changes as a proportion of the converter's largest torque
};

/// How the moves that a goal asks are made under a condition: what an engineer looks at beside the goal.
struct MoveBehaviour {
  std::optional<std::string> goal{};       ///< its name; "no goal" for moves that none of several asks
  std::optional<std::string> condition{};  ///< none without conditions
  std::size_t number{0};                   ///< of the goal in the study; their number for other moves
  std::int64_t moves{0};
  /// Counts: of the readings, or of the position where the goal is of the mass that does not close the loop.
  UpperValues overshoot;
  UpperValues overshoot_length;   ///< the same, rad
  UpperValues overshoot_of_step;  ///< the same as a proportion of the move's step; NaN where nothing steps
  double smallest_step{std::numeric_limits<double>::infinity()};  ///< counts
  UpperValues peak_torque;                                        ///< N m
  UpperValues peak_of_range;  ///< the same as a proportion of the converter's largest torque
  double range{std::numeric_limits<double>::infinity()};  ///< that torque, the smallest of the machines', N m
  double saturated{0.0};             ///< proportion of moves in which the converter clipped
  std::optional<RestTorque> rest{};  ///< where it is measured, and some move comes to rest
};

/// What the measures of a trial's moves are held against.
struct TrialScale {
  double resolution{0.0};      ///< of the fine encoder, rad
  double largest_torque{0.0};  ///< of the converter, N m
  std::vector<double> steps;   ///< [move] counts; empty for a sine
};
TrialScale scale_of(const trial::TrialParameters& p);

/// Counts the moves of trials by goal and condition; moves that no goal asks are a row of their own.
class BehaviourCounter {
 public:
  explicit BehaviourCounter(const study::Study& study);

  void add(const TrialScale& scale, std::int64_t condition, std::span<const trial::MoveOutcome> moves);
  /// By goal and condition, without rows that have no moves.
  std::vector<MoveBehaviour> behaviour() const;

 private:
  /// The moves of one row.
  struct RowValues {
    std::vector<double> overshoots, lengths, of_steps, peaks, of_ranges;
    std::int64_t moves{0};
    std::int64_t saturated{0};
    double smallest_step{std::numeric_limits<double>::infinity()};
    double range{std::numeric_limits<double>::infinity()};
    double power{0.0}, noise{0.0}, noise_of_range{0.0};  ///< sums of squares
    std::int64_t at_rest{0};

    void add(const trial::MoveOutcome& move, const TrialScale& scale, bool of_other_mass);
  };

  RowValues& row(std::size_t goal, std::int64_t condition);
  MoveBehaviour behaviour_of(const RowValues& values, std::size_t goal, std::size_t condition) const;

  const study::Study& study_;
  std::vector<measures::CountedGoal> goals_;
  std::size_t conditions_;
  std::vector<RowValues> rows_;  ///< [goal, then moves that none asks][condition]
};

/// That of the trials of a point in a results file. @param study of the file
std::vector<MoveBehaviour> behaviour_in(const reading::AllTrialsFile& file, const study::Study& study,
                                        std::int64_t point = 0);

}  // namespace zerocount::summary
