#pragma once

#include "core/loop/controller/control_block.hpp"
#include "core/numerics/number.hpp"

namespace zerocount::loop {

template <class Number>
struct FeedforwardConstants {
  Number velocity;      ///< Feed-forward torque per velocity ṙ of the reference, N m s/rad
  Number acceleration;  ///< Feed-forward torque per acceleration r̈ of the reference, N m s²/rad
  Number friction;      ///< Feed-forward torque in the direction of ṙ, N m
};

/// Feed-forward torque velocity·ṙ + acceleration·r̈ + friction·sgn(ṙ), N m.
/// @param velocity ṙ, rad/s.
/// @param acceleration r̈, rad/s².
template <class Number>
Number feedforward_torque(const FeedforwardConstants<Number>& c, const Number& velocity,
                          const Number& acceleration) {
  return c.velocity * velocity + c.acceleration * acceleration + c.friction * sign(velocity);
}

/// Feed-forward torque from the motion of the unrounded reference r (rad) at t_k. It is added to the torque u
/// of the blocks before:
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
    const FeedforwardConstants<double> c{gains_.velocity, gains_.acceleration, gains_.friction};
    added_ = feedforward_torque(c, now.reference.velocity, now.reference.acceleration);
  }
  static void pause(const Feedback& /*now*/) {}
  double take_over(double torque) const { return torque - added_; }

  static LinearChain linear() { return {}; }

 private:
  FeedforwardParameters gains_;
  double added_{0.0};  ///< Feed-forward torque added at the last sample, N m
};

}  // namespace zerocount::loop
