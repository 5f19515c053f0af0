// The plant while the hook sticks: the pre-sliding motion.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/sign.hpp"
#include "core/plant/events.hpp"
#include "core/plant/motion_series.hpp"
#include "core/plant/plant.hpp"

namespace zerocount {

double Plant::stick(const TorqueCourse& torque, double duration) {
  if (rest_ && is_constant(torque) && torque.now == rest_->torque) {
    go_on_at_rest(duration);
    return duration;
  }
  const bool stood = leave_rest();
  const double creep_rate_now = switch_creep();
  const Elongation elongation = elongation_under(torque.now, creep_rate_now);
  if (is_constant(torque)) {
    if (begin_rest(torque.now, elongation, stood)) {
      go_on_at_rest(duration);
      return duration;
    }
  } else if (at_rest(elongation)) {
    if (const double rest = time_at_rest(elongation, torque, duration); rest > 0.0) {
      hold_at_rest(rest);
      return rest;
    }
  }
  if (const int direction = slides_towards(torque.now); direction != 0) {
    break_away(direction);
    return 0.0;
  }
  spring_.set_direction(sign_of(elongation.rate != 0.0 ? elongation.rate : elongation.acceleration));
  deepest_ = std::max(deepest_, static_cast<std::int64_t>(spring_.depth()));

  const PreslidingSeries series =
      presliding_series(plant_, contact_, spring_, creep_, omega_, torque, creeping_);
  const double step =
      step_within(series.elongation, series.omega, series.exponent, tolerance_.elongation, duration);
  const NextEvent next =
      next_presliding_event(series, {plant_, contact_, spring_, creeping_, creep_onset_torque_}, step);

  omega_ = value_at(series.omega, next.time);
  creep_.extension = value_at(series.extension, next.time);
  creep_.hardening = value_at(series.hardening, next.time);
  spring_.move_on_branch(next.event == Event::closure ? *spring_.branch_end()
                                                      : value_at(series.elongation, next.time));
  pass(next.event);
  return next.time;
}

/// Turns the creep law on or off where it is time. @returns dxp/dt, rad/s.
double Plant::switch_creep() {
  if (!creeping_ && std::abs(spring_.torque()) >= creep_onset_torque_) creeping_ = true;
  const double rate = creep_rate();
  // The end of creep can lie closer to σ = 0 than the series of |σ|ⁿ sees, if n is no whole number.
  if (!creeping_ || rate * spring_.torque() > 0.0) return rate;
  end_creep();
  return 0.0;
}

/// dxp/dt, rad/s.
double Plant::creep_rate() const {
  if (!creeping_) return 0.0;
  const double torque = spring_.torque();
  return std::copysign(contact_.alpha * (hardening_limit(contact_, torque) - creep_.hardening), torque);
}

Plant::Elongation Plant::elongation_under(double torque, double creep_rate_now) const {
  const double unbalanced = torque - plant_.presliding_damping * omega_ - spring_.torque();
  return {omega_ - creep_rate_now, unbalanced / plant_.inertia + contact_.alpha * creep_rate_now};
}

bool Plant::at_rest(const Elongation& elongation) const {
  const double stiffness_per_inertia = (contact_.k1 + contact_.k2) / plant_.inertia;
  return std::abs(elongation.rate) < tolerance_.elongation * std::sqrt(stiffness_per_inertia) &&
         std::abs(elongation.acceleration) < tolerance_.elongation * stiffness_per_inertia;
}

/// For how long a torque that moves leaves the elongation at rest, s.
double Plant::time_at_rest(const Elongation& elongation, const TorqueCourse& torque, double duration) const {
  // Not less than the rounding of the torque, or the rest could end before the torque has changed.
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * std::abs(torque.now);
  const double whole =
      std::max(tolerance_.elongation * (contact_.k1 + contact_.k2), rounding) / plant_.inertia;
  if (!(std::abs(elongation.acceleration) < 0.5 * whole)) return 0.0;
  const double missing = std::copysign(whole, torque.settled - torque.now) - elongation.acceleration;
  return std::min(duration, time_until(torque, torque.now + plant_.inertia * missing));
}

/// The direction in which the hook slides from now on, or 0 where it holds.
int Plant::slides_towards(double torque) const {
  const double hook_torque = spring_.torque() + plant_.presliding_damping * omega_;
  const double motion = omega_ != 0.0 ? omega_ : torque - spring_.torque();
  const bool slides = std::abs(hook_torque) >= contact_.breakaway && hook_torque * motion > 0.0;
  return slides ? sign_of(motion) : 0;
}

void Plant::pass(Event event) {
  switch (event) {
    case Event::reversal:
      omega_ = creep_rate();  // dxs/dt is zero here, exactly
      break;
    case Event::creep_on:
      creeping_ = true;
      break;
    case Event::creep_off:
      end_creep();
      break;
    case Event::breakaway:
      break_away(sign_of(omega_));
      break;
    case Event::velocity_zero:
      omega_ = 0.0;
      break;
    case Event::closure:  // the spring has closed it
    case Event::none:
      break;
  }
}

void Plant::end_creep() {
  creeping_ = false;
  creep_onset_torque_ = creep_onset_after_end(contact_, creep_.hardening + tolerance_.elongation,
                                              spring_.torque(), spring_.elongation());
}

void Plant::hold_at_rest(double duration) {
  if (creeping_) {
    const double torque = spring_.torque();
    creep_ = creep_at_constant_torque(contact_, creep_, torque, duration);
    if (hardening_limit(contact_, torque) - creep_.hardening < 0.5 * tolerance_.elongation) {
      end_creep();
    }
  }
  omega_ = creep_rate();
}

}  // namespace zerocount
