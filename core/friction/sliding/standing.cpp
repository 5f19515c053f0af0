#include "core/friction/sliding/standing.hpp"

#include <cmath>

#include "core/motion/disturbance.hpp"
#include "core/motion/taylor_step.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::friction {
namespace {

/// Assumed rounding error of the torque at an instant, divided by the breakaway torque. The torque of a
/// coupling may be some hundred times as large as the part of it that matters here, and the time of a
/// vibration is rounded.
constexpr double rounding_of_torque = 1e-11;

/// Truncation error allowed in the torque's Taylor series, divided by the breakaway torque.
constexpr double tolerance_of_torque = 1e-13;

bool begins_to_fall(const numerics::Series& series) {
  for (std::size_t k = 1; k < series.size(); ++k)
    if (series[k] != 0.0) return series[k] < 0.0;
  return false;
}

}  // namespace

double StandingRotor::step_of_state(const StandingSeries& s, double, double duration) const {
  constexpr std::size_t last = numerics::series_order;
  numerics::Series terms{};
  terms[last - 1] = s.torque[last - 2];
  terms[last] = s.torque[last - 1];
  numerics::Series beyond{};
  if (disturbance != nullptr) beyond[last] = motion::vibration_beyond(*disturbance, last, 1.0);
  return motion::step_within(terms, beyond, s.exponent, tolerance_of_torque * contact.breakaway * duration,
                             duration);
}

motion::NextEvent<StandingRotor::Event> StandingRotor::first_event(const StandingSeries& s,
                                                                   double step) const {
  motion::NextEvent<Event> next{step};
  for (const double sign : {1.0, -1.0}) {
    numerics::Series margin = s.torque;
    for (double& coefficient : margin) coefficient *= -sign;
    margin[0] += contact.breakaway;
    if (contact.spent && std::abs(margin[0]) <= rounding_of_torque * contact.breakaway) margin[0] = 0.0;
    if (margin[0] < 0.0) return {0.0, Event::beyond};
    if (margin[0] > 0.0 || !begins_to_fall(margin)) {
      next.offer(motion::next_sign_change(margin, next.time), Event::at_level);
    } else if (!contact.spent) {
      return {0.0, Event::at_level};
    }
  }
  return next;
}

StandStep stand_step(const StandingContact& contact, const motion::TorqueCourse& torque, double tolerance,
                     double duration) {
  using Event = StandingRotor::Event;
  StandingRotor rotor{contact, torque.disturbance == nullptr ? nullptr : &torque.disturbance->of};
  const auto next = motion::taylor_step(rotor, contact.inertia, torque, tolerance, duration);
  // At the end of the duration the torque may change.
  const bool is_released = next.event != Event::none && next.time < duration;
  return {next.time, is_released ? rotor.direction : 0.0, next.event == Event::at_level};
}

}  // namespace zerocount::friction
