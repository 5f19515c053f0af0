#pragma once

#include "core/loop/control_block.hpp"
#include "core/loop/formulas.hpp"

namespace zerocount::loop {

struct PidGains {
  double kp{0.0};  ///< N m/count
  double ki{0.0};  ///< of the trapezoidal rule, N m/count
  double kd{0.0};  ///< on the difference of successive counts, N m/count
};

/// The PID law with the trapezoidal integral, the first block of the controller:
///
///   I ← I + ki·(e_k + e_{k−1}),   u = I + kp·e_k − kd·(count_k − count_{k−1});
///
///   U(z) = [kp + ki·(1 + z⁻¹)/(1 − z⁻¹)]·E(z) − kd·(1 − z⁻¹)·Count(z).
///
/// Before the first sample e was 0 and the count was the first count.
class Pid {
 public:
  Pid(const ControllerParameters& parameters, const ControlStart& start)
      : Pid({parameters.kp, parameters.ki, parameters.kd}, start.integral, start.integral_range) {}

  /// @param integral I before the first sample, N m.
  /// @param range what I is clamped to whenever it is changed by an error.
  Pid(const PidGains& gains, double integral, const TorqueRange& range)
      : constants_{gains.kp, gains.ki, gains.kd, range.lowest, range.highest}, state_{integral, 0.0, 0.0} {}

  double step(const Feedback& now, double /*torque*/ = 0.0) {
    if (!started_) state_.last_count = now.count;
    started_ = true;
    return pid_step(constants_, state_, now.error, now.count);
  }

  void observe(const Feedback& now) {
    started_ = true;
    state_.last_error = now.error;
    state_.last_count = now.count;
  }

  /// I := torque.
  void take_over(double torque) { state_.integral = torque; }

  /// Parts without gain are left out: an integral with ki = 0 would be a state that nothing moves.
  LinearBlock linear() const {
    const auto& [kp, ki, kd, lowest, highest] = constants_;
    LinearBlock block{{LoopSignal::error, {{kp}}}};
    if (ki != 0.0) block.push_back({LoopSignal::error, {{ki, ki}, {1.0, -1.0}}});
    if (kd != 0.0) block.push_back({LoopSignal::count, {{-kd, kd}}});
    return block;
  }

  double integral() const { return state_.integral; }  ///< I, N m

 private:
  PidConstants<double> constants_;
  PidState<double> state_;
  bool started_{false};
};

}  // namespace zerocount::loop
