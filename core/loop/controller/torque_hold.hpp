#pragma once

#include <algorithm>
#include <cmath>

#include "core/loop/controller/block_formulas.hpp"
#include "core/loop/controller/control_block.hpp"

namespace zerocount::loop {

/// The number of samples that a dwell (s) lasts: round(dwell·sample_rate), at least 1.
inline double dwell_samples(double dwell, double sample_rate) {
  return std::max(1.0, std::round(dwell * sample_rate));
}

inline HoldConstants<double> hold_constants(const Hold& hold, double sample_rate) {
  return {hold.enter, std::max(hold.enter, hold.leave), dwell_samples(hold.dwell, sample_rate)};
}

/// Holds the wanted torque of a chain at standstill: from the sample on at which |e| ≤ enter has lasted for
/// the dwell, the wanted torque is that of the sample before, and the blocks pause (ControlBlock::pause). The
/// first sample with |e| > leave, or with a new target, ends it. It never begins at the first sample of the
/// chain.
class TorqueHold {
 public:
  TorqueHold(const ControllerParameters& parameters, const ControlStart& /*start*/)
      : constants_(hold_constants(parameters.blocks.hold, parameters.sample_rate)) {}

  /// Whether this sample has the torque of the last one.
  bool holds(const Feedback& now) {
    const double fresh = now.new_target || !started_ ? 1.0 : 0.0;
    started_ = true;
    return holds_torque(constants_, state_, fresh, now.error);
  }
  void remember(double torque) { state_.torque = torque; }
  double torque() const { return state_.torque; }  ///< wanted at the last sample, N m
  /// The next sample is the chain's first.
  void restart() { started_ = false; }

 private:
  HoldConstants<double> constants_;
  HoldState<double> state_{0.0, 0.0, 0.0};
  bool started_{false};
};

}  // namespace zerocount::loop
