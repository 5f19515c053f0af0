#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/theory/stability.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"

/// Predictions by the paper's criteria (6) and (7), for each trial with its own friction.
namespace zerocount::theory {

/// Prediction for one trial.
///
/// k1 and k2 are those at the start of the trial: within one pre-sliding range they do not change (paper,
/// QN2). The paper's advice to use the lowest k1 of the working area is for a design.
struct TrialPrediction {
  /// Whether the criteria apply: not is_outside_theory(), and left_out_of_criteria() is empty.
  bool applies{true};
  IntegralGainBounds bounds;  ///< N m/count
  bool stable{false};         ///< (6): 0 < ki < bounds.stable_below
  bool unstable{false};  ///< (7): ki > bounds.unstable_above; also ki < 0, which no PID loop is stable with
};

TrialPrediction predict(const trial::TrialParameters& parameters);

/// Numbers of trials by their predictions. For the trials that are neither `stable` nor `unstable` the paper
/// predicts nothing.
struct PointPrediction {
  std::int64_t trials{0};
  std::int64_t stable{0};    ///< (6) holds
  std::int64_t unstable{0};  ///< (7) is exceeded
  std::int64_t outside{0};   ///< trials to which the criteria do not apply

  void add(const TrialPrediction& trial);
  PointPrediction operator+(const PointPrediction& other) const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.trials, self.stable, self.unstable, self.outside);
  }
};

/// Counts the predictions for the trials `rows`.
PointPrediction prediction_of(const study::Study& study, layout::RowRange rows);

/// The predictions of every point, [point].
/// @param known [point] predictions counted before; those that do not cover all trials are computed again
std::vector<PointPrediction> study_predictions(const study::Study& study,
                                               std::span<const PointPrediction> known = {});

/// The denominator of the proportions: all trials, or 0 if the criteria apply to none.
std::int64_t predicted_trials(const PointPrediction& prediction);

/// "stable" if (6) holds in every trial, "unstable" if (7) is exceeded in every trial, "unknown" without
/// trials, "not applicable" if the criteria apply to none of them, otherwise "undecided" with the
/// proportions of trials, such as "undecided: (6) holds in 12 %, (7) exceeded in 0 %".
std::string verdict(const PointPrediction& prediction);

}  // namespace zerocount::theory
