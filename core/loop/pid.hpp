#pragma once

#include <algorithm>
#include <optional>

#include "core/loop/control_block.hpp"

namespace zerocount {

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
      : gains_(gains), range_(range), integral_(integral) {}

  double step(const Feedback& now, double /*torque*/ = 0.0) {
    const double count_change = now.count - last_count_.value_or(now.count);
    integral_ += gains_.ki * (now.error + last_error_);
    integral_ = std::clamp(integral_, range_.lowest, range_.highest);
    observe(now);
    return integral_ + gains_.kp * now.error - gains_.kd * count_change;
  }

  void observe(const Feedback& now) {
    last_error_ = now.error;
    last_count_ = now.count;
  }

  /// I := torque.
  void take_over(double torque) { integral_ = torque; }

  /// Parts without gain are left out: an integral with ki = 0 would be a state that nothing moves.
  LinearBlock linear() const {
    LinearBlock block{{LoopSignal::error, {{gains_.kp}}}};
    if (gains_.ki != 0.0) block.push_back({LoopSignal::error, {{gains_.ki, gains_.ki}, {1.0, -1.0}}});
    if (gains_.kd != 0.0) block.push_back({LoopSignal::count, {{-gains_.kd, gains_.kd}}});
    return block;
  }

  double integral() const { return integral_; }  ///< I, N m

 private:
  PidGains gains_;
  TorqueRange range_;
  double integral_;
  double last_error_{0.0};
  std::optional<double> last_count_;
};

}  // namespace zerocount
