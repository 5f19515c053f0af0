#pragma once

#include "core/loop/controller/control_block.hpp"

/// Blocks of a controller that only the tests know.
namespace zerocount {

/// A low-pass block: y_k = a·y_{k−1} + (1 − a)·u_k.
class LowPass {
 public:
  static constexpr double decay = 0.6;  ///< coefficient a

  LowPass(const loop::ControllerParameters&, const loop::ControlStart&) {}

  double step(const loop::Feedback&, double torque) {
    output_ = decay * output_ + (1.0 - decay) * torque;
    return output_;
  }
  static void observe(const loop::Feedback&) {}
  static void pause(const loop::Feedback&) {}
  double take_over(double torque) { return output_ = torque; }
  static loop::LinearChain linear() { return {{{loop::LoopSignal::torque, {{1.0 - decay}, {1.0, -decay}}}}}; }

 private:
  double output_{0.0};
};

/// A feedback block: y_k = u_k − ¼·(torque decided at k − 1).
class TorqueFeedback {
 public:
  TorqueFeedback(const loop::ControllerParameters&, const loop::ControlStart&) {}

  static double step(const loop::Feedback& now, double torque) { return torque - 0.25 * now.torque_in_force; }
  static void observe(const loop::Feedback&) {}
  static void pause(const loop::Feedback&) {}
  static double take_over(double torque) { return torque; }
  static loop::LinearChain linear() {
    return {{{loop::LoopSignal::torque, {{1.0}}}, {loop::LoopSignal::torque_in_force, {{-0.25}}}}};
  }
};

}  // namespace zerocount
