#include "core/loop/pid.hpp"

#include <algorithm>

namespace zerocount {

double PidController::update(std::int64_t target, std::int64_t count) {
  const double error = static_cast<double>(target - count);
  const double count_change = static_cast<double>(count - last_count_.value_or(count));
  integral_ += parameters_.ki * (error + last_error_);
  if (parameters_.anti_windup == AntiWindup::clamp) integral_ = std::clamp(integral_, lowest_, highest_);
  last_error_ = error;
  last_count_ = count;
  return integral_ + parameters_.kp * error - parameters_.kd * count_change;
}

}  // namespace zerocount
