#include "core/friction/presliding/presliding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/friction/sliding/sliding.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::friction {
namespace {

/// Fraction of the breakaway torque below which the sign of the spring torque σ is a matter of rounding. A
/// new contact with such a σ starts at the origin of the virgin curve, because the side on which it starts
/// decides whether a reversal there is remembered.
constexpr double torque_without_sign = 1e-14;

}  // namespace

PreslidingFriction::PreslidingFriction(const motion::PlantParameters& plant, FrictionAlongRotor friction,
                                       const motion::PlantStart& start, motion::MotionTolerance tolerance)
    : plant_(plant),
      friction_(std::move(friction)),
      position_(start.position),
      tolerance_(tolerance),
      contact_(friction_at(friction_, position_)),
      spring_(contact_),
      omega_(start.velocity) {
  sliding_ = start.sliding && start.velocity != 0.0;
  if (sliding_) {
    slide_direction_ = numerics::sign_of(start.velocity);
    breakaway_spring_torque_ = slide_direction_ * contact_.breakaway;
  }
  spring_.start_virgin(0.0, 0);
  if (!sliding_) {
    creep_.hardening = start.hardening;
    spring_.start_preloaded(start.preload);
    if (start.holding != 0.0) spring_.move_to_torque(start.holding);
    for (const double torque : start.history) spring_.move_to_torque(torque);
    if (!start.history.empty()) spring_.move_to_torque(0.0);
  }
  creep_onset_torque_ = creep_onset_torque(contact_, creep_.hardening + tolerance.elongation);
  hook_ = -spring_.elongation();
  forget_deepest();
}

PlantMotion PreslidingFriction::motion() const {
  return {elongation(), omega_,   creep_,       creeping_,        creep_onset_torque_,
          hook_,        sliding_, slide_theta_, slide_direction_, breakaway_spring_torque_};
}

void PreslidingFriction::set_motion(const PlantMotion& motion) {
  rest_.reset();
  oscillation_ = {0.0, 0.0, 0.0};
  spring_.place(motion.elongation);
  omega_ = motion.omega;
  creep_ = motion.creep;
  creeping_ = motion.creeping;
  creep_onset_torque_ = motion.creep_onset_torque;
  hook_ = motion.hook;
  sliding_ = motion.sliding;
  slide_theta_ = motion.slide_theta;
  slide_direction_ = motion.slide_direction;
  breakaway_spring_torque_ = motion.breakaway_spring_torque;
}

void PreslidingFriction::break_away(double direction) {
  slide_theta_ = theta();
  slide_direction_ = direction;
  const double spring_torque = spring_.torque();
  breakaway_spring_torque_ =
      std::abs(spring_torque) < torque_without_sign * contact_.breakaway ? 0.0 : spring_torque;
  sliding_ = true;
  ++breakaways_;
}

double PreslidingFriction::slide(const motion::TorqueCourse& torque, double duration) {
  Slide slide{contact_, plant_.sliding_damping, slide_theta_, omega_, slide_direction_};
  const SlideStep step = slide_step(slide, plant_.inertia, torque, tolerance_.elongation, duration);
  slide_theta_ = slide.theta;
  omega_ = slide.omega;
  if (step.ended) re_stick();
  return step.time;
}

void PreslidingFriction::re_stick() {
  contact_ = friction_at(friction_, position_ + slide_theta_, ++contact_number_);
  spring_ = HystereticSpring(contact_);
  spring_.start_virgin(virgin_elongation(contact_, breakaway_spring_torque_),
                       numerics::sign_of(slide_direction_));
  hook_ = slide_theta_ - spring_.elongation();
  creep_ = {};
  creeping_ = false;
  creep_onset_torque_ = creep_onset_torque(contact_, tolerance_.elongation);
  omega_ = 0.0;
  sliding_ = false;
}

double PreslidingFriction::stick(const motion::TorqueCourse& torque, double duration) {
  const bool constant = motion::is_steady(torque);
  if (rest_ && constant && torque.now == rest_->torque) {
    go_to(point_at_rest(duration));
    motion::let_load_follow(torque, omega_);
    return duration;
  }
  const bool was_at_rest = leave_rest();
  const double creep_rate_now = switch_creep();
  const double torque_now = motion::torque_on_rotor(torque, omega_);
  const Elongation elongation = elongation_under(torque_now, creep_rate_now);
  if (constant) {
    const bool quiet = load_is_quiet(torque, creep_rate_now);
    if (quiet && begin_rest(torque.now, elongation, was_at_rest, torque.load == nullptr)) {
      go_to(point_at_rest(duration));
      motion::let_load_follow(torque, omega_);
      return duration;
    }
  } else if (!motion::is_coupled(torque) && at_rest(elongation)) {
    if (const double rest = time_at_rest(elongation, torque, duration); rest > 0.0) {
      hold_at_rest(rest);
      return rest;
    }
  }
  if (const int direction = breakaway_direction(torque_now); direction != 0) {
    break_away(direction);
    return 0.0;
  }
  // At rest, the motion starts in the direction in which the torque changes.
  double heading = elongation.rate != 0.0 ? elongation.rate : elongation.acceleration;
  if (heading == 0.0) heading = motion::change_of_torque(torque, omega_);
  if (heading != 0.0) spring_.set_direction(numerics::sign_of(heading));
  deepest_ = std::max(deepest_, depth());

  Sticking motion{contact_,  plant_.presliding_damping, spring_, creep_, omega_,
                  creeping_, creep_onset_torque_};
  const auto next = motion::taylor_step(motion, plant_.inertia, torque, tolerance_.elongation, duration);
  pass(next.event);
  return next.time;
}

/// Turns the creep law on or off, depending on the hardening and the spring torque.
/// @returns the rate of creep dxp/dt, rad/s.
double PreslidingFriction::switch_creep() {
  if (!creeping_ && std::abs(spring_.torque()) >= creep_onset_torque_) creeping_ = true;
  const double rate = creep_rate();
  // For a fractional n the end of creep can lie closer to σ = 0 than the series of |σ|ⁿ resolves.
  if (!creeping_ || rate * spring_.torque() > 0.0) return rate;
  end_creep();
  return 0.0;
}

/// Rate of creep dxp/dt, rad/s; 0 while creep is off.
double PreslidingFriction::creep_rate() const {
  if (!creeping_) return 0.0;
  const double torque = spring_.torque();
  return std::copysign(contact_.alpha * (hardening_limit(contact_, torque) - creep_.hardening), torque);
}

PreslidingFriction::Elongation PreslidingFriction::elongation_under(double torque,
                                                                    double creep_rate_now) const {
  const double unbalanced = torque - plant_.presliding_damping * omega_ - spring_.torque();
  return {omega_ - creep_rate_now, unbalanced / plant_.inertia + contact_.alpha * creep_rate_now};
}

bool PreslidingFriction::at_rest(const Elongation& elongation) const {
  const double stiffness_per_inertia = (contact_.k1 + contact_.k2) / plant_.inertia;
  return std::abs(elongation.rate) < tolerance_.elongation * std::sqrt(stiffness_per_inertia) &&
         std::abs(elongation.acceleration) < tolerance_.elongation * stiffness_per_inertia;
}

/// The time (s), at most `duration`, for which a varying torque leaves the elongation of the spring at rest.
double PreslidingFriction::time_at_rest(const Elongation& elongation, const motion::TorqueCourse& torque,
                                        double duration) const {
  // At least the rounding error of the torque, so that the torque changes before the rest ends.
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * std::abs(torque.now);
  const double whole =
      std::max(tolerance_.elongation * (contact_.k1 + contact_.k2), rounding) / plant_.inertia;
  if (!(std::abs(elongation.acceleration) < 0.5 * whole)) return 0.0;
  const double missing = std::copysign(whole, torque.settled - torque.now) - elongation.acceleration;
  return std::min(duration, motion::time_until(torque, torque.now + plant_.inertia * missing));
}

/// The direction (−1 or 1) in which the contact breaks away now under the torque (N m), or 0 if it holds.
int PreslidingFriction::breakaway_direction(double torque) const {
  const double hook_torque = spring_.torque() + plant_.presliding_damping * omega_;
  const double motion = omega_ != 0.0 ? omega_ : torque - spring_.torque();
  const bool breaks_away = std::abs(hook_torque) >= contact_.breakaway && hook_torque * motion > 0.0;
  return breaks_away ? numerics::sign_of(motion) : 0;
}

void PreslidingFriction::pass(Sticking::Event event) {
  switch (event) {
    case Sticking::Event::reversal:
      omega_ = creep_rate();  // dxs/dt is zero here, exactly
      break;
    case Sticking::Event::creep_on:
      creeping_ = true;
      break;
    case Sticking::Event::creep_off:
      end_creep();
      break;
    case Sticking::Event::breakaway:
      break_away(numerics::sign_of(omega_));
      break;
    case Sticking::Event::velocity_zero:
      omega_ = 0.0;
      break;
    case Sticking::Event::closure:  // handled by the spring
    case Sticking::Event::none:
      break;
  }
}

void PreslidingFriction::end_creep() {
  creeping_ = false;
  creep_onset_torque_ = creep_onset_after_end(contact_, creep_.hardening + tolerance_.elongation,
                                              spring_.torque(), spring_.elongation());
}

void PreslidingFriction::hold_at_rest(double duration) {
  if (creeping_) {
    const double torque = spring_.torque();
    creep_ = creep_at_constant_torque(contact_, creep_, torque, duration);
    if (hardening_limit(contact_, torque) - creep_.hardening < 0.5 * tolerance_.elongation) {
      end_creep();
    }
  }
  omega_ = creep_rate();
}

}  // namespace zerocount::friction
