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
  std::vector<LimitCycle> by_function;  ///< by describing function
  bool sticks{false};                   ///< stick-slip is predicted: the friction is Coulomb's
  std::vector<LimitCycle> by_stick_slip;
};

/// None where the loop is open, the controller is a plugin, or the friction has no describing function.
std::optional<HuntingPrediction> predict_hunting(const trial::TrialParameters& trial);

}  // namespace zerocount::theory
