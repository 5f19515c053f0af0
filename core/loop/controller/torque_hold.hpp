#pragma once

#include <algorithm>
#include <cmath>

#include "core/loop/controller/block_formulas.hpp"
#include "core/loop/controller/control_block.hpp"

namespace zerocount::loop {

/// The number of samples that a dwell time (s) lasts: round(dwell·sample_rate), at least 1.
/// @param sample_rate Hz.
inline double dwell_samples(double dwell, double sample_rate) {
  return std::max(1.0, std::round(dwell * sample_rate));
}

inline HoldConstants<double> hold_constants(const Hold& hold, double sample_rate) {
  return {hold.enter, std::max(hold.enter, hold.leave), dwell_samples(hold.dwell, sample_rate)};
}

/// Holds the wanted torque of a chain of controller blocks at standstill. Once |e| ≤ enter has lasted for the
/// dwell time, the wanted torque keeps the value of the sample before, and the blocks pause
/// (ControlBlock::pause). The hold ends at the first sample with |e| > leave or with a new target. It never
/// begins at the first sample of the chain.
class TorqueHold {
 public:
  TorqueHold(const ControllerParameters& parameters, const ControlStart& /*start*/)
      : constants_(hold_constants(parameters.blocks.hold, parameters.sample_rate)) {}

  /// Updates the hold by the feedback of this sample.
  /// @returns whether the torque of the last sample is held.
  bool holds(const Feedback& now) {
    const double fresh = now.new_target || !started_ ? 1.0 : 0.0;
    started_ = true;
    return holds_torque(constants_, state_, fresh, now.error);
  }
  void remember(double torque) { state_.torque = torque; }
  double torque() const {
    return state_.torque;
  }  ///< Wanted torque at the last sample, which the hold
     /// < keeps, N m
  /// Declares that the next sample is the first one of the chain of blocks, at which no hold begins.
  void restart() { started_ = false; }

 private:
  HoldConstants<double> constants_;
  HoldState<double> state_{0.0, 0.0, 0.0};
  bool started_{false};
};

}  // namespace zerocount::loop
