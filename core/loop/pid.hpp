#pragma once

#include "core/loop/count_difference.hpp"
#include "core/loop/integrator.hpp"

namespace zerocount::loop {

struct PidGains {
  double kp{0.0};  ///< N m/count
  double ki{0.0};  ///< of the trapezoidal rule, N m/count
  double kd{0.0};  ///< on the difference of successive counts, N m/count
};

/// The PID law with the trapezoidal integral:
///
///   I ← I + ki·(e_k + e_{k−1}),   u = I + kp·e_k − kd·d_k;
///
///   U(z) = [kp + ki·(1 + z⁻¹)/(1 − z⁻¹)]·E(z) − kd·D(z),
///
/// with the conditions on I and its leak by Integrator, and d the difference of successive counts by
/// CountDifference. Before the first sample e was 0.
class Pid {
 public:
  Pid(const ControllerParameters& parameters, const ControlStart& start)
      : Pid({parameters.kp, parameters.ki, parameters.kd},
            Integrator(integral_constants(parameters.blocks, parameters.sample_rate, start.integral_range),
                       start.integral),
            CountDifference(derivative_pole(parameters.blocks, parameters.sample_rate))) {}

  /// The law without blocks.
  /// @param integral I before the first sample, N m.
  /// @param range what I is clamped to whenever it is changed by an error.
  Pid(const PidGains& gains, double integral, const TorqueRange& range)
      : Pid(gains, Integrator(integral_constants({}, 1.0, range), integral), CountDifference(0.0)) {}

  double step(const Feedback& now, double /*torque*/ = 0.0) {
    const double d = difference_.step(now.count);
    const double integral = integral_.add(now.error, gains_.ki * (now.error + last_error_));
    last_error_ = now.error;
    return pid_torque(integral, gains_.kp, now.error, gains_.kd, d);
  }

  void observe(const Feedback& now) {
    difference_.step(now.count);
    integral_.observe(now.error);
    last_error_ = now.error;
  }

  /// I := torque. @returns 0, because the law is the first block.
  double take_over(double torque) {
    integral_.set(torque);
    return 0.0;
  }

  /// Without the parts that have no gain: an integral with ki = 0 would be a constant state.
  LinearChain linear() const {
    LinearBlock block{{LoopSignal::error, {{gains_.kp}}}};
    if (gains_.ki != 0.0) block.push_back({LoopSignal::error, integral_.trapezoid(gains_.ki)});
    if (gains_.kd != 0.0) block.push_back({LoopSignal::count, difference_.transfer(-gains_.kd)});
    return {block};
  }

  double integral() const { return integral_.value(); }  ///< I, N m

 private:
  Pid(const PidGains& gains, const Integrator& integral, const CountDifference& difference)
      : gains_(gains), integral_(integral), difference_(difference) {}

  PidGains gains_;
  Integrator integral_;
  CountDifference difference_;
  double last_error_{0.0};
};

}  // namespace zerocount::loop
