#include "core/trial/position_error.hpp"

#include <algorithm>
#include <cmath>

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
  const double followed = reference.is_sine() ? reference.exact_at(t) * resolution_ : target_;
  const double error = followed + offset_ - theta;
  overshoot_ = std::max(overshoot_, -error * direction_);
  for (std::size_t i = 0; i < p_.verdict.tolerances.count; ++i) {
    if (std::abs(error) > p_.verdict.tolerances.limits[i]) last_outside_[i] = k;
  }
  last_ = k;
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
