#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/theory/hunting.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::theory {

/// The hunting that theory predicts of a trial.
struct HuntingPrediction {
  std::string_view left_out;            ///< part of the loop that the predictions do not model; else empty
  double count_angle{0.0};              ///< Δx of the fine encoder, rad
  bool grows_while_sliding{false};      ///< the loop is unstable while the rotor slides
  double sample_time{0.0};              ///< T, s
  std::vector<LimitCycle> by_function;  ///< by describing function
  double range{0.0};                    ///< by which the bristle yields before it slides, rad; 0 for a relay
  bool sticks{false};                   ///< stick-slip is sought: the first move is longer than the range
  std::vector<LimitCycle> by_stick_slip;
};

/// Why a predicted cycle is rough: it is within a third of what trials show, otherwise within a twentieth.
enum class Roughness {
  none,
  few_counts,   ///< the amplitude is below 10 counts
  few_samples,  ///< fewer than 10 samples a period
  bristle       ///< slides on a bristle, whose elastic travel the prediction makes at once
};

Roughness roughness_of(const LimitCycle& cycle, const HuntingPrediction& hunting);

/// None where the loop is open, the controller is a plugin, or the friction has no describing function.
std::optional<HuntingPrediction> predict_hunting(const trial::TrialParameters& trial);

}  // namespace zerocount::theory
