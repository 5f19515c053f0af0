#include "core/trial/position_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/number.hpp"

namespace zerocount::trial {

PositionError::PositionError(const TrialParameters& p, double resolution)
    : p_(p), resolution_(resolution), offset_((0.5 - p.initial.encoder_phase) * resolution) {}

double PositionError::exact_target(std::size_t number) const {
  return p_.command.exact_targets.empty() ? static_cast<double>(p_.command.targets[number]) * resolution_
                                          : p_.command.exact_targets[number];
}

void PositionError::start_move(std::size_t number) {
  target_ = exact_target(number);
  direction_ = sign(target_ - (number == 0 ? 0.0 : exact_target(number - 1)));
  overshoot_ = 0.0;
  last_ = -1;
  last_outside_.fill(-1);
}

void PositionError::add(std::int64_t k, double theta, const loop::Reference& reference) {
  const double t = static_cast<double>(k) / p_.controller.sample_rate;
  add_error(k, theta, reference.moves_for_ever() ? reference.exact_at(t) * resolution_ : target_);
}

void PositionError::add_at_target(std::int64_t k, double theta) {
  for (std::int64_t& outside : last_outside_) {
    if (outside == last_) outside = k - 1;  // it stayed outside, or there was no sample
  }
  add_error(k, theta, target_);
}

void PositionError::add_error(std::int64_t k, double theta, double followed) {
  error_ = followed + offset_ - theta;
  overshoot_ = std::max(overshoot_, -error_ * direction_);
  for (std::size_t i = 0; i < p_.verdict.tolerances.count; ++i) {
    if (std::abs(error_) > p_.verdict.tolerances.limits[i]) last_outside_[i] = k;
  }
  last_ = k;
}

PositionError::Range PositionError::quiet_range() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double lowest = -infinity, highest = infinity;  // of ε
  for (std::size_t i = 0; i < p_.verdict.tolerances.count; ++i) {
    const double tolerance = p_.verdict.tolerances.limits[i];
    if (error_ > tolerance) {
      lowest = std::max(lowest, tolerance);
    } else if (error_ < -tolerance) {
      highest = std::min(highest, -tolerance);
    } else {
      lowest = std::max(lowest, -tolerance);
      highest = std::min(highest, tolerance);
    }
  }
  if (direction_ > 0.0) lowest = std::max(lowest, -overshoot_);
  if (direction_ < 0.0) highest = std::min(highest, overshoot_);
  const double zero = target_ + offset_;
  return {zero - highest, zero - lowest};
}

void PositionError::finish(MoveOutcome& outcome) const {
  if (outcome.stopped || outcome.outcome == Outcome::nonfinite) return;
  outcome.true_overshoot = overshoot_;
  for (std::size_t i = 0; i < p_.verdict.tolerances.count; ++i) {
    if (last_outside_[i] < last_) {
      outcome.tolerance_settling_times[i] =
          static_cast<double>(last_outside_[i] + 1) / p_.controller.sample_rate;
    }
  }
}

}  // namespace zerocount::trial
