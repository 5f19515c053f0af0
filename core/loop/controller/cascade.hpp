#pragma once

#include "core/loop/controller/count_difference.hpp"
#include "core/loop/controller/integrator.hpp"

namespace zerocount::loop {

inline CascadeConstants<double> cascade_constants(const CascadeGains& gains, double sample_rate,
                                                  double resolution) {
  return {gains.kv * resolution, sample_rate * resolution, gains.kp, 0.5 * gains.ki / sample_rate};
}

/// The usual cascade of a drive, a proportional position loop around a PI velocity loop:
///
///   v*_k = kv·Δx·e_k,   v_k = (Δx/T)·d_k,   w_k = v*_k − v_k                                 (rad/s)
///   I ← I + (ki·T/2)·(w_k + w_{k−1}),   u = kp·w_k + I                                       (N m)
///
///   U(z) = [kp + (ki·T/2)·(1 + z⁻¹)/(1 − z⁻¹)]·[kv·Δx·E(z) − (Δx/T)·D(z)],
///
/// with e′ of the dead zone (acting_error) in place of e, the conditions on I, by the position error e, and
/// its leak by Integrator, and d the difference of successive counts by CountDifference. Before the first
/// sample w was 0. Source: Groß, Hamann, Wiegärtner, "Electrical Feed Drives in Automation", Siemens/MCD
/// 2001, chapter 3.
class Cascade {
 public:
  Cascade(const ControllerParameters& parameters, const ControlStart& start)
      : constants_(cascade_constants(parameters.blocks.cascade, parameters.sample_rate, start.resolution)),
        deadband_(error_deadband_constants(parameters.blocks.error_deadband)),
        integral_(integral_constants(parameters.blocks, parameters.sample_rate, start.integral_range),
                  start.integral),
        difference_(derivative_pole(parameters.blocks, parameters.sample_rate)) {}

  double step(const Feedback& now, double /*torque*/ = 0.0) {
    const double error = acting_error(deadband_, now.error);
    const double w = velocity_error(constants_, error, difference_.step(now.count));
    const double integral = integral_.add(now.error, constants_.ki * (w + last_velocity_error_));
    last_velocity_error_ = w;
    return cascade_torque(integral, constants_.kp, w);
  }

  void observe(const Feedback& now) {
    const double error = acting_error(deadband_, now.error);
    last_velocity_error_ = velocity_error(constants_, error, difference_.step(now.count));
    integral_.observe(now.error);
  }

  void pause(const Feedback& now) {
    difference_.pass(now.count);
    last_velocity_error_ =
        velocity_error(constants_, acting_error(deadband_, now.error), difference_.value());
  }

  /// I := torque. @returns 0, because the law is the first block.
  double take_over(double torque) {
    integral_.set(torque);
    return 0.0;
  }

  LinearChain linear() const {
    const LinearBlock position_loop{{LoopSignal::error, {{constants_.kv}}},
                                    {LoopSignal::count, difference_.transfer(-constants_.velocity)}};
    LinearBlock velocity_loop{{LoopSignal::torque, {{constants_.kp}}}};
    if (constants_.ki != 0.0) {
      velocity_loop.push_back({LoopSignal::torque, integral_.trapezoid(constants_.ki)});
    }
    return {position_loop, velocity_loop};
  }

  double integral() const { return integral_.value(); }  ///< I, N m

 private:
  CascadeConstants<double> constants_;
  ErrorDeadbandConstants<double> deadband_;
  Integrator integral_;
  CountDifference difference_;
  double last_velocity_error_{0.0};
};

}  // namespace zerocount::loop
