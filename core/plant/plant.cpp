#include "core/plant/plant.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "core/numerics/first_root.hpp"
#include "core/plant/motion_series.hpp"

namespace zerocount {
namespace {

/// More steps than this within one torque step mean that the motion cannot be followed. A ringing trial of
/// the paper's rig takes about three.
constexpr int most_steps = 200000;

int sign_of(double value) {
  return (value > 0.0) - (value < 0.0);
}

/// Series of a·t-dependent quantity minus a constant, for root finding.
Series less(Series series, double constant) {
  series[0] -= constant;
  return series;
}

Series scaled_difference(double constant, double factor, Series series) {
  for (double& coefficient : series) coefficient *= -factor;
  series[0] += constant;
  return series;
}

/// dxs/dt, whose k-th coefficient is (k+1)·xs[k+1].
std::array<double, series_order> elongation_rate(const PreslidingSeries& series) {
  std::array<double, series_order> rate{};
  for (std::size_t k = 0; k < series_order; ++k)
    rate[k] = static_cast<double>(k + 1) * series.elongation[k + 1];
  return rate;
}

/// First time in (0, end] at which `series` changes sign, where a start at exactly zero does not count.
std::optional<double> next_sign_change(std::span<const double> series, double end) {
  if (series[0] == 0.0) series = series.subspan(1);
  if (series[0] == 0.0) return std::nullopt;
  return first_sign_change(series, end);
}

enum class Event { none, reversal, closure, creep_on, creep_off, breakaway, velocity_zero };

/// The first kink ahead within a step.
struct NextEvent {
  double time;
  Event event{Event::none};

  void offer(std::optional<double> candidate, Event what) {
    if (!candidate || *candidate > time) return;
    time = *candidate;
    event = what;
  }
};

/// The loop closure ahead. The elongation is monotonic up to `next.time`, where the next reversal would be.
void find_closure(const HystereticSpring& spring, const PreslidingSeries& series, NextEvent& next) {
  const std::optional<double> end = spring.branch_end();
  if (!end) return;
  const Series distance = less(series.elongation, *end);
  if (spring.direction() * value_at(distance, next.time) < 0.0) return;
  next.offer(bracketed_root(distance, 0.0, next.time), Event::closure);
}

/// The start or end of creep. σ is monotonic up to `next.time`, so it passes the onset at most once.
void find_creep_change(const PreslidingSeries& series, bool creeping, double onset_torque, NextEvent& next) {
  if (creeping) {
    next.offer(next_sign_change(series.creep_rate, next.time), Event::creep_off);
    return;
  }
  const double at_end = value_at(series.spring_torque, next.time);
  if (std::abs(at_end) < onset_torque) return;
  const Series beyond = less(series.spring_torque, std::copysign(onset_torque, at_end));
  next.offer(bracketed_root(beyond, 0.0, next.time), Event::creep_on);
}

/// The instant at which |σ + c·ω| reaches the breakaway torque in the direction of motion.
void find_breakaway(const PlantParameters& plant, const FrictionParameters& contact,
                    const PreslidingSeries& series, NextEvent& next) {
  Series hook_torque{};
  for (std::size_t k = 0; k <= series_order; ++k) {
    hook_torque[k] = series.spring_torque[k] + plant.presliding_damping * series.omega[k];
  }
  if (std::abs(hook_torque[0]) + excursion_bound(hook_torque, next.time) < contact.breakaway) return;
  for (const double sign : {1.0, -1.0}) {
    if (sign * hook_torque[0] >= contact.breakaway) continue;
    const Series margin = scaled_difference(contact.breakaway, sign, hook_torque);
    const std::optional<double> reached = first_sign_change(margin, next.time);
    if (reached && sign * value_at(series.omega, *reached) > 0.0) next.offer(reached, Event::breakaway);
  }
  // Where the level is passed against the motion, the hook holds until the motion turns.
  next.offer(next_sign_change(series.omega, next.time), Event::velocity_zero);
}

}  // namespace

Plant::Plant(const PlantParameters& plant, FrictionAlongRotor friction, double position, double hardening,
             double preload, MotionTolerance tolerance)
    : plant_(plant),
      friction_(std::move(friction)),
      position_(position),
      tolerance_(tolerance),
      contact_(friction_at(friction_, position)),
      spring_(contact_),
      creep_{0.0, hardening},
      creep_onset_torque_(creep_onset_torque(contact_, hardening + tolerance.elongation)) {
  spring_.start_preloaded(preload);
  hook_ = -spring_.elongation();
  forget_deepest();
}

void Plant::advance(double torque, double duration) {
  double remaining = duration;
  for (int step = 0; remaining > 0.0 && finite_; ++step) {
    if (step == most_steps) finite_ = false;
    const double used = sliding_ ? slide(torque, remaining) : stick(torque, remaining);
    remaining = used < remaining ? remaining - used : 0.0;
    finite_ = finite_ && std::isfinite(theta()) && std::isfinite(omega_);
  }
}

/// dxp/dt, rad/s.
double Plant::creep_rate() const {
  if (!creeping_) return 0.0;
  const double torque = spring_.torque();
  return std::copysign(contact_.alpha * (hardening_limit(contact_, torque) - creep_.hardening), torque);
}

double Plant::stick(double torque, double duration) {
  const double spring_torque = spring_.torque();
  if (!creeping_ && std::abs(spring_torque) >= creep_onset_torque_) creeping_ = true;

  const double creep_rate_now = creep_rate();
  const double rate = omega_ - creep_rate_now;  // dxs/dt
  const double acceleration =                   // d²xs/dt², exact where dxs/dt is zero
      (torque - plant_.presliding_damping * omega_ - spring_torque) / plant_.inertia +
      contact_.alpha * creep_rate_now;
  const double stiffness_per_inertia = (contact_.k1 + contact_.k2) / plant_.inertia;
  if (std::abs(rate) < tolerance_.elongation * std::sqrt(stiffness_per_inertia) &&
      std::abs(acceleration) < tolerance_.elongation * stiffness_per_inertia) {
    hold_at_rest(duration);
    return duration;
  }
  const double hook_torque = spring_torque + plant_.presliding_damping * omega_;
  const double motion = omega_ != 0.0 ? omega_ : torque - spring_torque;
  if (std::abs(hook_torque) >= contact_.breakaway && hook_torque * motion > 0.0) {
    break_away(sign_of(motion));
    return 0.0;
  }

  spring_.set_direction(sign_of(rate != 0.0 ? rate : acceleration));
  deepest_ = std::max(deepest_, static_cast<std::int64_t>(spring_.depth()));
  const PreslidingSeries series =
      presliding_series(plant_, contact_, spring_, creep_, omega_, torque, creeping_);

  NextEvent next{
      step_within(series.elongation, series.omega, series.exponent, tolerance_.elongation, duration)};
  next.offer(next_sign_change(elongation_rate(series), next.time), Event::reversal);
  find_closure(spring_, series, next);
  find_creep_change(series, creeping_, creep_onset_torque_, next);
  find_breakaway(plant_, contact_, series, next);

  omega_ = value_at(series.omega, next.time);
  creep_.extension = value_at(series.extension, next.time);
  creep_.hardening = value_at(series.hardening, next.time);
  spring_.move_on_branch(next.event == Event::closure ? *spring_.branch_end()
                                                      : value_at(series.elongation, next.time));

  switch (next.event) {
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
    case Event::closure:
    case Event::none:
      break;
  }
  return next.time;
}

void Plant::end_creep() {
  creeping_ = false;
  // The onset lies beyond the rounding of σ, or creep would set in again at once where σ moves by less than
  // that per step.
  const double torque = std::abs(spring_.torque());
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() *
                          (torque + (contact_.k1 + contact_.k2) * std::abs(spring_.elongation()));
  creep_onset_torque_ =
      std::max(creep_onset_torque(contact_, creep_.hardening + tolerance_.elongation), torque + rounding);
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

void Plant::break_away(double direction) {
  slide_theta_ = theta();
  slide_direction_ = direction;
  breakaway_spring_torque_ = spring_.torque();
  sliding_ = true;
  ++breakaways_;
}

double Plant::slide(double torque, double duration) {
  const SlidingSeries series =
      sliding_series(plant_, contact_, slide_theta_, omega_, slide_direction_, torque);
  if (omega_ == 0.0 && !(slide_direction_ * series.omega[1] > 0.0)) {
    re_stick();
    return 0.0;
  }
  NextEvent next{step_within(series.theta, series.omega, series.exponent, tolerance_.elongation, duration)};
  next.offer(next_sign_change(series.omega, next.time), Event::velocity_zero);
  slide_theta_ = value_at(series.theta, next.time);
  omega_ = value_at(series.omega, next.time);
  if (next.event == Event::velocity_zero) re_stick();
  return next.time;
}

void Plant::re_stick() {
  contact_ = friction_at(friction_, position_ + slide_theta_);
  spring_ = HystereticSpring(contact_);
  spring_.start_virgin(virgin_elongation(contact_, breakaway_spring_torque_), sign_of(slide_direction_));
  hook_ = slide_theta_ - spring_.elongation();
  creep_ = {};
  creeping_ = false;
  creep_onset_torque_ = creep_onset_torque(contact_, tolerance_.elongation);
  omega_ = 0.0;
  sliding_ = false;
}

}  // namespace zerocount
