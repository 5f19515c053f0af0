#include "core/friction/sliding/standing.hpp"

#include <cmath>

#include "core/motion/disturbance.hpp"
#include "core/motion/taylor_step.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::friction {
namespace {

/// Rounding of the torque at an instant, by the breakaway torque: the torque of a coupling may be some
/// hundred times as large as its part that counts, and the time of a vibration is rounded.
constexpr double rounding_of_torque = 1e-11;

/// Truncation error allowed of the torque, by the breakaway torque.
constexpr double tolerance_of_torque = 1e-13;

struct StandingSeries {
  numerics::Series position{};  ///< 0
  numerics::Series omega{};     ///< 0
  numerics::Series exponent{};  ///< 0
  numerics::Series torque{};    ///< on the rotor, N m
};

bool begins_to_fall(const numerics::Series& series) {
  for (std::size_t k = 1; k < series.size(); ++k)
    if (series[k] != 0.0) return series[k] < 0.0;
  return false;
}

/// A rotor at rest while the torque on it, u − Ts, is within the breakaway torque.
struct StandingRotor {
  using Expansion = StandingSeries;
  enum class Event { none, at_level, beyond };

  StandingContact contact;
  const motion::VaryingTorque* disturbance;  ///< may be null
  double direction{0};                       ///< of the torque on it at the end of the step: −1, 1

  static StandingSeries start() { return {}; }
  static double expand(StandingSeries& s, std::size_t k, double torque) {
    s.torque[k] = torque;
    return 0.0;
  }
  /// The torque moves nothing while the rotor stands, so that no error of the position limits the step. Its
  /// series ends before series_order. Of a motor and a load the last two terms, times t, stay below the
  /// tolerance times t. Those of a line of a vibration may vanish, one at each extreme, and those of several
  /// lines cancel: what they leave out is bounded line by line.
  double step_of_state(const StandingSeries& s, double, double duration) const {
    constexpr std::size_t last = numerics::series_order;
    numerics::Series terms{};
    terms[last - 1] = s.torque[last - 2];
    terms[last] = s.torque[last - 1];
    numerics::Series beyond{};
    if (disturbance != nullptr) beyond[last] = motion::vibration_beyond(disturbance->of, last, 1.0);
    return motion::step_within(terms, beyond, s.exponent, tolerance_of_torque * contact.breakaway * duration,
                               duration);
  }
  motion::NextEvent<Event> first_event(const StandingSeries& s, double step) const {
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
  void go_to(const StandingSeries& s, const motion::NextEvent<Event>& next) {
    direction = numerics::sign_of(numerics::value_at(s.torque, next.time));
  }
};

}  // namespace

StandStep stand_step(const StandingContact& contact, const motion::TorqueCourse& torque, double tolerance,
                     double duration) {
  using Event = StandingRotor::Event;
  StandingRotor rotor{contact, torque.disturbance};
  const auto next = motion::taylor_step(rotor, contact.inertia, torque, tolerance, duration);
  // At the end of the duration the torque may change.
  const bool is_released = next.event != Event::none && next.time < duration;
  return {next.time, is_released ? rotor.direction : 0.0, next.event == Event::at_level};
}

}  // namespace zerocount::friction
