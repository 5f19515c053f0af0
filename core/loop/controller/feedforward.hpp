#pragma once

#include "core/loop/controller/control_block.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::loop {

/// Torque from the motion of the unrounded reference r (rad) at t_k, added to that of the blocks before:
///
///   u + velocity·ṙ + acceleration·r̈ + friction·sgn(ṙ),   sgn(0) = 0.
///
/// It is not in the loop: its transfer function from the torque is 1.
class Feedforward {
 public:
  Feedforward(const ControllerParameters& parameters, const ControlStart& /*start*/)
      : gains_(parameters.blocks.feedforward) {}

  double step(const Feedback& now, double torque) {
    observe(now);
    return torque + added_;
  }
  void observe(const Feedback& now) {
    const auto& [velocity, acceleration, position] = now.reference;
    added_ = gains_.velocity * velocity + gains_.acceleration * acceleration +
             gains_.friction * numerics::sign_of(velocity);
  }
  static void pause(const Feedback& /*now*/) {}
  double take_over(double torque) const { return torque - added_; }

  static LinearChain linear() { return {}; }

 private:
  FeedforwardParameters gains_;
  double added_{0.0};  ///< at the last sample, N m
};

}  // namespace zerocount::loop
