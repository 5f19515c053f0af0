#pragma once

#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "core/motion/parameters.hpp"
#include "core/theory/stability.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"

/// Predictions by the paper's criteria (6) and (7), for each trial with its own friction.
namespace zerocount::theory {

/// Prediction for one trial.
///
/// k1 and k2 are those at the start of the trial: within one pre-sliding range they do not change (paper,
/// QN2). The paper's advice to use the lowest k1 of the working area is for a design.
struct TrialPrediction {
  /// True if the criteria apply: is_outside_theory() is false and left_out_of_criteria() is empty.
  bool applies{true};
  IntegralGainBounds bounds;  ///< Bounds of the integral gain by criteria (6) and (7), N m/count.
  bool stable{false};         ///< True if criterion (6) holds: 0 < ki < bounds.stable_below.
  /// True if criterion (7) of the paper is exceeded, ki > bounds.unstable_above, or if ki < 0, because no PID
  /// loop is stable then. Always false if `applies` is false.
  bool unstable{false};
};

TrialPrediction predict(const trial::TrialParameters& parameters);

/// Numbers of a design point's trials by their stability predictions. For the trials that are neither
/// `stable` nor `unstable` the paper predicts nothing.
struct PointPrediction {
  std::int64_t trials{0};
  std::int64_t stable{0};    ///< Number of trials in which criterion (6) holds.
  std::int64_t unstable{0};  ///< Number of trials in which criterion (7) is exceeded.
  std::int64_t outside{0};   ///< Number of trials to which the criteria do not apply.

  void add(const TrialPrediction& trial);
  PointPrediction operator+(const PointPrediction& other) const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.trials, self.stable, self.unstable, self.outside);
  }
};

/// Counts the stability predictions for the trials with the global rows `rows`.
PointPrediction prediction_of(const study::Study& study, layout::RowRange rows);

/// [point] Numbers of trials by their stability predictions, for every design point.
/// @param known [point] predictions counted before; those that do not cover all trials are computed again
std::vector<PointPrediction> study_predictions(const study::Study& study,
                                               std::span<const PointPrediction> known = {});

/// The number of trials to which proportions of predictions refer: all trials, or 0 if the criteria apply to
/// none.
std::int64_t predicted_trials(const PointPrediction& prediction);

/// Verdict of the stability criteria on a design point: "stable" if (6) holds in every trial, "unstable" if
/// (7) is exceeded in every trial, "unknown" without trials, "not applicable" if the criteria apply to none
/// of them, otherwise "undecided" with the proportions of trials, such as "undecided: (6) holds in 12 %, (7)
/// exceeded in 0 %".
std::string verdict(const PointPrediction& prediction);

/// A step of the targets of a trial, from one position to the next, counts.
struct TargetStep {
  std::int64_t from{0};
  std::int64_t to{0};

  std::int64_t length() const { return std::abs(to - from); }
};

/// Target steps of all moves, in order.
std::vector<TargetStep> target_steps(const trial::CommandParameters& command);

// Linear loops that approximate a trial at rest and while its rotor slides.

/// Whether a trial has no linear loop to analyse: the loop is open, or the controller is a plugin, whose
/// transfer function is not known.
bool has_no_linear_loop(const trial::TrialParameters& parameters);

/// Whether criteria (6) and (7) do not apply to this trial, because its loop is not linear with the motor on
/// a pre-sliding spring. It is equal in all trials of a point.
bool is_outside_theory(const trial::TrialParameters& parameters);

/// Reason why is_outside_theory() is true: "the loop is open", …; empty if it is false.
std::string why_outside_theory(const trial::TrialParameters& parameters);

/// The linear model of the trial's converter and amplifier.
LinearDrive drive_of(const trial::TrialParameters& parameters);

/// The plant with its inertia split into two halves, motor and load, that oscillate against each other. The
/// sum of the inertias is kept. The encoder is on the motor, and the damping of the coupling is 1 % of the
/// critical damping.
/// @param plant without a second mass
/// @param frequency of the free mode, Hz
motion::PlantParameters with_load_mode(motion::PlantParameters plant, double frequency);

}  // namespace zerocount::theory
