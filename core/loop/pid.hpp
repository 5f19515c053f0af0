#pragma once

#include <cstdint>
#include <optional>

#include "core/loop/parameters.hpp"

namespace zerocount {

/// The sampled PID control of the count, with the trapezoidal integral:
///
///   I ← I + ki·(e_k + e_{k−1}),   u = I + kp·e_k − kd·(count_k − count_{k−1}).
///
/// Before the first sample e was 0 and the count was the first count.
class PidController {
 public:
  /// @param lowest, highest the DAC's range (N m), to which anti-windup clamps the integral.
  PidController(const ControllerParameters& parameters, double lowest, double highest)
      : parameters_(parameters), lowest_(lowest), highest_(highest) {}

  /// The wanted torque (N m) at this sample, from `target` and `count` (counts).
  double update(std::int64_t target, std::int64_t count);

  double integral() const { return integral_; }  ///< I, N m

 private:
  ControllerParameters parameters_;
  double lowest_;
  double highest_;
  double integral_{0.0};
  double last_error_{0.0};
  std::optional<std::int64_t> last_count_;
};

}  // namespace zerocount
