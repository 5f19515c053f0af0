#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::theory {

/// A goal and a trial that is to meet it.
struct GoalOfTrial {
  const study::Study& study;
  const study::Goal& goal;  ///< of a study without one: zero counts at the end of the move
  const trial::TrialParameters& trial;

  bool feeds_back_coarse() const { return trial.controller.encoder == loop::EncoderChoice::coarse; }
  double count() const;  ///< of the encoder that closes the loop, rad
  const loop::EncoderErrors& errors() const {
    return feeds_back_coarse() ? trial.encoder.coarse_errors : trial.encoder.fine_errors;
  }
  /// From one end of the band or tolerance to the other, rad.
  double width() const;
  /// Samples of the shortest move of the goal at which it must be within the band.
  double samples_within() const;

  std::string unit(const char* rotary) const;
  std::string length(double value) const;
  std::string torque(double value) const;
  std::string band_text() const;
};

/// A move of the trial that the goal asks.
struct MoveOfTrial {
  const GoalOfTrial& of;
  std::size_t number;
  double from, to;  ///< targets from the start of the trial, before rounding to counts, rad

  double distance() const;
  double direction() const { return to < from ? -1.0 : 1.0; }
  double within() const;  ///< s from its start, by goal and hold
  std::string name() const { return "move " + std::to_string(number); }
};

/// The moves that the goal asks, without those of no length; of very many the first ones. Empty without
/// targets, and where the reference does not end.
std::vector<MoveOfTrial> moves_of(const GoalOfTrial& of);

/// Result of a test: a factor that is above 1 where the goal is out of reach, and the reason.
struct Doubt {
  double ratio{0.0};
  std::string text{};
};

}  // namespace zerocount::theory
