#include "core/plant/plant.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numerics/sign.hpp"
#include "core/plant/events.hpp"
#include "core/plant/free_motion.hpp"
#include "core/plant/motion_series.hpp"

namespace zerocount {
namespace {

/// More steps than this within one torque step mean that the motion cannot be followed. A ringing trial of
/// the paper's rig takes about three.
constexpr int most_steps = 200000;

/// A torque has settled when this many time constants have passed: exp(−37) is below the rounding of 1.
constexpr double time_constants_to_settle = 37.0;

/// Below this share of the breakaway torque the sign of σ is a matter of rounding. Which side of the virgin
/// curve a new contact starts on must not be: it decides whether a turn of the motion there is remembered.
constexpr double torque_without_sign = 1e-14;

bool slides_at_start(FrictionModel model, const PlantStart& start) {
  switch (model) {
    case FrictionModel::presliding:
    case FrictionModel::spring:
      return start.sliding && start.velocity != 0.0;
    case FrictionModel::coulomb:
      return start.velocity != 0.0;
    case FrictionModel::none:
      break;
  }
  return true;
}

/// The sign with which a slide leaves ω = 0, or 0 where it does not.
int departure(const SlidingSeries& series) {
  for (const double coefficient : series.omega) {
    if (coefficient != 0.0) return sign_of(coefficient);
  }
  return 0;
}

}  // namespace

Plant::Plant(const PlantParameters& plant, FrictionAlongRotor friction, const PlantStart& start,
             MotionTolerance tolerance)
    : plant_(plant),
      friction_(std::move(friction)),
      position_(start.position),
      tolerance_(tolerance),
      contact_(friction_at(friction_, position_)),
      spring_(contact_),
      omega_(start.velocity) {
  const bool has_contact_spring = has_spring(friction_.model);
  sliding_ = slides_at_start(friction_.model, start);
  if (sliding_) {
    slide_direction_ = sign_of(start.velocity);
    breakaway_spring_torque_ = has_contact_spring ? slide_direction_ * contact_.breakaway : 0.0;
  }
  spring_.start_virgin(0.0, 0);
  if (!sliding_ && has_contact_spring) {
    creep_.hardening = start.hardening;
    spring_.start_preloaded(start.preload);
    for (const double torque : start.history) spring_.move_to_torque(torque);
    if (!start.history.empty()) spring_.move_to_torque(0.0);
  }
  creep_onset_torque_ = creep_onset_torque(contact_, creep_.hardening + tolerance.elongation);
  hook_ = -spring_.elongation();
  forget_deepest();
}

void Plant::advance(const TorqueCourse& torque, double duration) {
  TorqueCourse ahead = torque;
  bool moves = !is_constant(ahead);
  double remaining = duration;
  for (int step = 0; remaining > 0.0 && finite_; ++step) {
    if (step == most_steps) finite_ = false;
    const double used = step_on(ahead, remaining);
    remaining = used < remaining ? remaining - used : 0.0;
    if (moves) {
      moves = duration - remaining < time_constants_to_settle / ahead.rate;
      ahead = moves ? course_after(ahead, used) : constant_torque(ahead.settled);
    }
    finite_ = finite_ && std::isfinite(theta()) && std::isfinite(omega_);
  }
}

double Plant::step_on(const TorqueCourse& torque, double duration) {
  switch (friction_.model) {
    case FrictionModel::presliding:
    case FrictionModel::spring:
      return sliding_ ? slide(torque, duration) : stick(torque, duration);
    case FrictionModel::coulomb:
      return sliding_ ? slide(torque, duration) : stand(torque, duration);
    case FrictionModel::none:
      break;
  }
  return move_freely(torque, duration);
}

double Plant::move_freely(const TorqueCourse& torque, double duration) {
  const FreeMotion end = free_motion(plant_, {slide_theta_, omega_}, torque, duration);
  slide_theta_ = end.theta;
  omega_ = end.omega;
  return duration;
}

PlantMotion Plant::motion() const {
  return {elongation(), omega_,   creep_,       creeping_,        creep_onset_torque_,
          hook_,        sliding_, slide_theta_, slide_direction_, breakaway_spring_torque_};
}

void Plant::set_motion(const PlantMotion& motion) {
  rest_.reset();
  swing_ = {0.0, 0.0, 0.0};
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

void Plant::break_away(double direction) {
  slide_theta_ = theta();
  slide_direction_ = direction;
  const double spring_torque = spring_.torque();
  breakaway_spring_torque_ =
      std::abs(spring_torque) < torque_without_sign * contact_.breakaway ? 0.0 : spring_torque;
  sliding_ = true;
  ++breakaways_;
}

double Plant::slide(const TorqueCourse& torque, double duration) {
  const SlidingSeries series =
      sliding_series(plant_, contact_, slide_theta_, omega_, slide_direction_, torque);
  if (omega_ == 0.0 && departure(series) != slide_direction_) {
    re_stick();
    return 0.0;
  }
  const double step =
      step_within(series.theta, series.omega, series.exponent, tolerance_.elongation, duration);
  const NextEvent next = next_sliding_event(series, step);
  slide_theta_ = value_at(series.theta, next.time);
  omega_ = value_at(series.omega, next.time);
  if (next.event == Event::velocity_zero) re_stick();
  return next.time;
}

void Plant::re_stick() {
  contact_ = friction_at(friction_, position_ + slide_theta_, ++contact_number_);
  spring_ = HystereticSpring(contact_);
  spring_.start_virgin(virgin_elongation(contact_, breakaway_spring_torque_), sign_of(slide_direction_));
  hook_ = slide_theta_ - spring_.elongation();
  creep_ = {};
  creeping_ = false;
  creep_onset_torque_ = creep_onset_torque(contact_, tolerance_.elongation);
  omega_ = 0.0;
  sliding_ = false;
}

/// Whether a slide in `direction` can leave ω = 0 under the torque.
bool Plant::torque_drives(double direction, const TorqueCourse& torque) const {
  return departure(sliding_series(plant_, contact_, 0.0, 0.0, direction, torque)) == direction;
}

/// A Coulomb contact. |u| can pass the breakaway torque at most once, and only towards where it settles,
/// because u is monotonic. What moves nothing in the arithmetic counts as within the level: the rotor would
/// slide and stick without end.
double Plant::stand(const TorqueCourse& torque, double duration) {
  if (std::abs(torque.now) > contact_.breakaway && torque_drives(sign_of(torque.now), torque)) {
    break_away(sign_of(torque.now));
    return 0.0;
  }
  if (is_constant(torque) || std::abs(torque.settled) <= contact_.breakaway) return duration;
  const double direction = sign_of(torque.settled);
  // From the level itself, where rounding has no say in whether it is passed.
  const TorqueCourse release{direction * contact_.breakaway, torque.settled, torque.rate};
  const double waiting = time_until(torque, release.now);
  if (!(waiting < duration) || !torque_drives(direction, release)) return duration;
  break_away(direction);
  return waiting + slide(release, duration - waiting);
}

}  // namespace zerocount
