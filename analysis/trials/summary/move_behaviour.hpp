#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/trials/measures/move_criterion.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::summary {

/// The 95 % quantile and the maximum of a quantity over some moves; NaN without values.
struct UpperValues {
  double p95{std::numeric_limits<double>::quiet_NaN()};
  double max{std::numeric_limits<double>::quiet_NaN()};
};

/// The commanded torque while the axis is at rest after its moves (MoveOutcome::rest_torque_power).
struct RestTorque {
  double rms{0.0};       ///< Root mean square of the torque at rest over all moves, N m.
  double changes{0.0};   ///< Rms over all moves of the torque's change from sample to sample, N m.
  double of_range{0.0};  ///< Rms of the changes as a proportion of the converter's largest torque.
};

/// Behaviour of the moves that a goal judges, in one setting (condition at an age): quantities that an
/// engineer looks at beside the goal.
struct MoveBehaviour {
  std::optional<std::string> goal{};  ///< Name of the goal; "no goal" for moves that no goal judges.
  /// Name of the setting (condition at an age); empty without settings.
  std::optional<std::string> setting{};
  /// Index of the goal in the study; the number of goals for moves that no goal judges.
  std::size_t number{0};
  std::int64_t moves{0};
  /// Overshoot in counts: of the readings, or of the true position if the goal is about the mass that does
  /// not close the loop.
  UpperValues overshoot;
  UpperValues overshoot_length;   ///< Overshoot as a length, rad or m.
  UpperValues overshoot_of_step;  ///< Overshoot as a proportion of the move's step; NaN if no move is a step.
  /// Smallest size of a move's step, counts; infinite if no move is a step.
  double smallest_step{std::numeric_limits<double>::infinity()};
  UpperValues peak_torque;    ///< Peak of the torque's magnitude, N m.
  UpperValues peak_of_range;  ///< Peak torque as a proportion of the converter's largest torque.
  /// Largest torque that the converter can give, N m: the minimum over the trials.
  double range{std::numeric_limits<double>::infinity()};
  double saturated{0.0};  ///< Proportion of moves in which the converter clipped the torque.
  /// Torque at rest; empty if it is not measured, or no move comes to rest.
  std::optional<RestTorque> rest{};
};

/// Reference values to which the measures of a trial's moves are related.
struct TrialScale {
  double resolution{0.0};      ///< Resolution of the fine encoder, rad.
  double largest_torque{0.0};  ///< Largest torque of the converter, N m.
  std::vector<double> steps;   ///< [move] Size of the step, counts; empty if the reference is a sine.
};
TrialScale scale_of(const trial::TrialParameters& p);

/// Collects statistics of the moves of trials, separately for each goal and setting (condition at an age).
/// Moves that no goal judges are collected separately.
class BehaviourCounter {
 public:
  explicit BehaviourCounter(const study::Study& study);

  void add(const TrialScale& scale, std::int64_t setting, std::span<const trial::MoveOutcome> moves);
  /// The behaviour for each goal and setting, ordered by goal, then by setting; combinations without moves
  /// are left out.
  std::vector<MoveBehaviour> behaviour() const;

 private:
  /// Values of the moves for one goal in one setting.
  struct RowValues {
    std::vector<double> overshoots, lengths, of_steps, peaks, of_ranges;
    std::int64_t moves{0};
    std::int64_t saturated{0};
    double smallest_step{std::numeric_limits<double>::infinity()};
    double range{std::numeric_limits<double>::infinity()};
    /// Sums over the moves at rest of the mean squares of: torque, change of torque, change as a proportion
    /// of the converter's range.
    double power{0.0}, noise{0.0}, noise_of_range{0.0};
    std::int64_t at_rest{0};

    void add(const trial::MoveOutcome& move, const TrialScale& scale, bool of_other_mass);
  };

  RowValues& row(std::size_t goal, std::int64_t setting);
  MoveBehaviour behaviour_of(const RowValues& values, std::size_t goal, std::size_t setting) const;

  const study::Study& study_;
  std::vector<measures::MoveCriterion> goals_;
  std::size_t settings_;
  /// [goal][setting] Values of the moves; the last goal stands for moves that no goal judges.
  std::vector<RowValues> rows_;
};

/// The behaviour of the moves at a design point, from a results file.
/// @param study study of the file
std::vector<MoveBehaviour> behaviour_in(const reading::AllTrialsFile& file, const study::Study& study,
                                        std::int64_t point = 0);

}  // namespace zerocount::summary
