#pragma once

#include <cstdint>
#include <string>

#include "core/theory/stability.hpp"
#include "core/trial/parameters.hpp"

/// Predictions by the paper's criteria (6) and (7) for the trials of a design point, each with its own
/// friction.
namespace zerocount::measures {

/// Prediction for one trial.
///
/// k1 and k2 are those at the start of the trial: within one pre-sliding range they do not change (paper,
/// QN2). The paper's advice to use the lowest k1 of the working area is for a design.
struct TrialPrediction {
  /// Whether the criteria apply to this trial: the loop is closed, the friction has a pre-sliding spring, and
  /// the controller has no blocks that the criteria leave out.
  bool applies{true};
  theory::IntegralGainBounds bounds;  ///< N m/count
  bool stable{false};                 ///< (6): 0 < ki < bounds.stable_below
  bool unstable{false};  ///< (7): ki > bounds.unstable_above; also ki < 0, which no PID loop is stable with
};

TrialPrediction predict(const trial::TrialParameters& parameters);

/// The trials of a point by their predictions. The paper makes no prediction for the other trials.
struct TheoryPrediction {
  std::int64_t trials{0};
  std::int64_t stable{0};    ///< (6) holds
  std::int64_t unstable{0};  ///< (7) is exceeded
  std::int64_t outside{0};   ///< trials to which the criteria do not apply

  void add(const TrialPrediction& trial);
  TheoryPrediction operator+(const TheoryPrediction& other) const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.trials, self.stable, self.unstable, self.outside);
  }
};

/// The denominator of the proportions: all trials, or 0 if the criteria apply to none.
std::int64_t predicted_trials(const TheoryPrediction& prediction);

/// "stable" if (6) holds in every trial, "unstable" if (7) is exceeded in every trial, "unknown" without
/// trials, "not applicable" if the criteria apply to none of them, otherwise "undecided" with the
/// proportions of trials, such as "undecided: (6) holds in 12 %, (7) exceeded in 0 %".
std::string verdict(const TheoryPrediction& prediction);

}  // namespace zerocount::measures
