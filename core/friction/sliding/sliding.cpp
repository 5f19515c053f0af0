#include "core/friction/sliding/sliding.hpp"

#include "core/numerics/sign.hpp"

namespace zerocount::friction {

SlidingSeries Slide::start() const {
  StribeckCurve curve = stribeck_curve(contact);
  curve.coulomb *= direction;
  curve.excess *= direction;
  SlidingSeries series{{}, {damping, curve}};
  series.position[0] = theta;
  series.omega[0] = omega;
  series.decay[0] = decay_at(curve, omega);
  return series;
}

motion::NextEvent<Slide::Event> Slide::first_event(const SlidingSeries& series, double step) {
  motion::NextEvent<Event> next{step};
  next.offer(motion::next_sign_change(series.omega, next.time), Event::velocity_zero);
  return next;
}

void Slide::go_to(const SlidingSeries& series, const motion::NextEvent<Event>& next) {
  theta = numerics::value_at(series.position, next.time);
  omega = numerics::value_at(series.omega, next.time);
}

namespace {

bool leaves_rest(const SlidingSeries& series, double direction) {
  for (const double coefficient : series.omega) {
    if (coefficient != 0.0) return numerics::sign_of(coefficient) == direction;
  }
  return false;
}

}  // namespace

bool leaves_rest(const Slide& slide, double inertia, const motion::TorqueCourse& torque) {
  motion::LoadSeries load_series;
  return leaves_rest(motion::motion_series(slide, inertia, torque, load_series), slide.direction);
}

SlideStep slide_step(Slide& slide, double inertia, const motion::TorqueCourse& torque, double tolerance,
                     double duration) {
  motion::LoadSeries load_series;
  const SlidingSeries series = motion::motion_series(slide, inertia, torque, load_series);
  if (slide.omega == 0.0 && !leaves_rest(series, slide.direction)) return {0.0, true};
  const auto next = motion::step_along(series, load_series, torque, slide, tolerance, duration);
  return {next.time, next.event == Slide::Event::velocity_zero};
}

}  // namespace zerocount::friction
