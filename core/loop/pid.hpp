#pragma once

#include <algorithm>
#include <optional>

namespace zerocount {

struct PidGains {
  double kp{0.0};  ///< N m/count
  double ki{0.0};  ///< of the trapezoidal rule, N m/count
  double kd{0.0};  ///< on the difference of successive counts, N m/count
};

/// Bounds of a torque, N m.
struct TorqueRange {
  double lowest{0.0};
  double highest{0.0};
};

/// What a control is fed back at a sampling instant: whole numbers, or those of a coarser encoder in counts
/// of the fine one.
struct Feedback {
  double error{0.0};  ///< reference − count, counts
  double count{0.0};  ///< counts
};

/// The law of the sampled PID control, with the trapezoidal integral:
///
///   I ← I + ki·(e_k + e_{k−1}),   u = I + kp·e_k − kd·(count_k − count_{k−1}).
///
/// Before the first sample e was 0 and the count was the first count.
class PidController {
 public:
  /// @param integral I before the first sample, N m.
  /// @param range what I is clamped to whenever it is changed by an error.
  PidController(const PidGains& gains, double integral, const TorqueRange& range)
      : gains_(gains), range_(range), integral_(integral) {}

  /// The wanted torque (N m) at this sample.
  double update(const Feedback& now) {
    const double count_change = now.count - last_count_.value_or(now.count);
    integral_ += gains_.ki * (now.error + last_error_);
    integral_ = std::clamp(integral_, range_.lowest, range_.highest);
    observe(now);
    return integral_ + gains_.kp * now.error - gains_.kd * count_change;
  }

  /// A sample at which another law decides: only what the next one has to know of it is kept.
  void observe(const Feedback& now) {
    last_error_ = now.error;
    last_count_ = now.count;
  }

  /// Sets I (N m), from which the next sample goes on.
  void set_integral(double integral) { integral_ = integral; }

  double integral() const { return integral_; }  ///< I, N m

 private:
  PidGains gains_;
  TorqueRange range_;
  double integral_;
  double last_error_{0.0};
  std::optional<double> last_count_;
};

}  // namespace zerocount
