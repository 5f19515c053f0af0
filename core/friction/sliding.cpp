#include "core/friction/sliding.hpp"

#include "core/numerics/sign.hpp"

namespace zerocount {

SlidingSeries Slide::start() const {
  SlidingSeries series;
  series.position[0] = theta;
  series.omega[0] = omega;
  const double coulomb = contact.coulomb_ratio * contact.breakaway;
  series.coulomb = direction * coulomb;
  series.stribeck = direction * (contact.breakaway - coulomb);
  series.per_velocity_squared = 1.0 / (contact.stribeck_velocity * contact.stribeck_velocity);
  return series;
}

NextEvent<Slide::Event> Slide::first_event(const SlidingSeries& series, double step) {
  NextEvent<Event> next{step};
  next.offer(next_sign_change(series.omega, next.time), Event::velocity_zero);
  return next;
}

void Slide::go_to(const SlidingSeries& series, const NextEvent<Event>& next) {
  theta = value_at(series.position, next.time);
  omega = value_at(series.omega, next.time);
}

namespace {

bool leaves_rest(const SlidingSeries& series, double direction) {
  for (const double coefficient : series.omega) {
    if (coefficient != 0.0) return sign_of(coefficient) == direction;
  }
  return false;
}

}  // namespace

bool leaves_rest(const Slide& slide, double inertia, const TorqueCourse& torque) {
  return leaves_rest(motion_series(slide, inertia, torque), slide.direction);
}

SlideStep slide_step(Slide& slide, double inertia, const TorqueCourse& torque, double tolerance,
                     double duration) {
  const SlidingSeries series = motion_series(slide, inertia, torque);
  if (slide.omega == 0.0 && !leaves_rest(series, slide.direction)) return {0.0, true};
  const auto next = step_along(series, slide, tolerance, duration);
  return {next.time, next.event == Slide::Event::velocity_zero};
}

}  // namespace zerocount
