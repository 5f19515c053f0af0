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

/// The 95 % quantile and the maximum of a quantity over some moves; NaN without values.
struct UpperValues {
  double p95{std::numeric_limits<double>::quiet_NaN()};
  double max{std::numeric_limits<double>::quiet_NaN()};
};

/// The commanded torque while the moves are at rest (MoveOutcome::rest_torque_power).
struct RestTorque {
  double rms{0.0};       ///< Rms of the torque over all moves, N m.
  double changes{0.0};   ///< Rms over all moves of the torque's change from sample to sample, N m.
  double of_range{0.0};  ///< Rms of the changes as a proportion of the converter's largest torque.
};

/// Behaviour, in one setting, of the moves that a goal judges: quantities that an engineer looks at
/// beside the goal.
struct MoveBehaviour {
  std::optional<std::string> goal{};     ///< Name of the goal; "no goal" for moves that no goal judges.
  std::optional<std::string> setting{};  ///< Name of the setting; empty without settings.
  /// Index of the goal in the study; the number of goals for moves that no goal judges.
  std::size_t number{0};
  std::int64_t moves{0};
  /// Overshoot in counts: of the readings, or of the true position if the goal is about the mass that does
  /// not close the loop.
  UpperValues overshoot;
  UpperValues overshoot_length;   ///< Overshoot, rad.
  UpperValues overshoot_of_step;  ///< Overshoot as a proportion of the move's step; NaN if no move is a step.
  double smallest_step{std::numeric_limits<double>::infinity()};  ///< counts
  UpperValues peak_torque;                                        ///< N m
  UpperValues peak_of_range;  ///< Peak torque as a proportion of the converter's largest torque.
  /// Largest torque of the converter, N m: the minimum over the trials.
  double range{std::numeric_limits<double>::infinity()};
  double saturated{0.0};  ///< proportion of moves in which the converter clipped
  /// Empty if the torque at rest is not measured, or no move comes to rest.
  std::optional<RestTorque> rest{};
};

/// Reference values to which the measures of a trial's moves are related.
struct TrialScale {
  double resolution{0.0};      ///< Resolution of the fine encoder, rad.
  double largest_torque{0.0};  ///< Largest torque of the converter, N m.
  std::vector<double> steps;   ///< [move] size of the step, counts; empty for a sine
};
TrialScale scale_of(const trial::TrialParameters& p);

/// Collects the moves of trials in rows, one for each goal and setting. Moves that no goal judges have rows
/// of their own.
class BehaviourCounter {
 public:
  explicit BehaviourCounter(const study::Study& study);

  void add(const TrialScale& scale, std::int64_t setting, std::span<const trial::MoveOutcome> moves);
  /// The rows ordered by goal, then by setting; rows without moves are left out.
  std::vector<MoveBehaviour> behaviour() const;

 private:
  /// The moves of one row.
  struct RowValues {
    std::vector<double> overshoots, lengths, of_steps, peaks, of_ranges;
    std::int64_t moves{0};
    std::int64_t saturated{0};
    double smallest_step{std::numeric_limits<double>::infinity()};
    double range{std::numeric_limits<double>::infinity()};
    double power{0.0}, noise{0.0}, noise_of_range{0.0};  ///< sums of mean squares over the moves at rest
    std::int64_t at_rest{0};

    void add(const trial::MoveOutcome& move, const TrialScale& scale, bool of_other_mass);
  };

  RowValues& row(std::size_t goal, std::int64_t setting);
  MoveBehaviour behaviour_of(const RowValues& values, std::size_t goal, std::size_t setting) const;

  const study::Study& study_;
  std::vector<measures::CountedGoal> goals_;
  std::size_t settings_;
  std::vector<RowValues> rows_;  ///< [goal][setting]; the last goal stands for moves that no goal judges
};

/// The behaviour of the moves of a point in a results file. @param study study of the file
std::vector<MoveBehaviour> behaviour_in(const reading::AllTrialsFile& file, const study::Study& study,
                                        std::int64_t point = 0);

}  // namespace zerocount::summary
