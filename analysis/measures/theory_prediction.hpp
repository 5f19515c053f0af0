#pragma once

#include <cstdint>
#include <string>

#include "core/theory/stability.hpp"
#include "core/trial/parameters.hpp"

/// What the paper's criteria (6) and (7) say of the trials of a design point, each with its own friction.
namespace zerocount::measures {

/// What the criteria say of one trial.
///
/// k1 and k2 are those where the trial starts: within one pre-sliding range they do not change (paper, QN2).
/// The paper's advice to take the lowest k1 of the working area is for a design; a trial is governed by the
/// k1 it meets.
struct TrialPrediction {
  /// Whether the criteria are about this trial: the loop is closed, and friction has a spring before it
  /// slides.
  bool applies{true};
  theory::IntegralGainBounds bounds;  ///< N m/count
  bool stable{false};                 ///< (6): 0 < ki < bounds.stable_below
  bool unstable{false};  ///< (7): ki > bounds.unstable_above; also ki < 0, which no PID loop is stable with
};

TrialPrediction predict(const trial::TrialParameters& parameters);

/// The trials of a point by what the criteria say of them; those of neither kind are left undecided by the
/// paper.
struct TheoryPrediction {
  std::int64_t trials{0};
  std::int64_t stable{0};    ///< (6) holds
  std::int64_t unstable{0};  ///< (7) is exceeded
  std::int64_t outside{0};   ///< trials that the criteria are not about

  void add(const TrialPrediction& trial);
};

/// The trials that the proportions are of: all, or none where the criteria are about none.
std::int64_t predicted_trials(const TheoryPrediction& prediction);

/// "stable" if (6) holds in every trial, "unstable" if (7) is exceeded in every trial, "unknown" without
/// trials, "not applicable" where the criteria are about none of them, otherwise "undecided" with the
/// proportions of trials, such as "undecided: (6) holds in 12 %, (7) exceeded in 0 %".
std::string verdict(const TheoryPrediction& prediction);

}  // namespace zerocount::measures
