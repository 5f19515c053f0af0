#include "core/friction/sliding/standing.hpp"

#include "core/motion/taylor_step.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::friction {
namespace {

struct StandingSeries {
  numerics::Series position{};  ///< 0
  numerics::Series omega{};     ///< 0
  numerics::Series exponent{};  ///< 0
  numerics::Series torque{};    ///< on the rotor, N m
};

/// A rotor at rest while the torque on it, u − Ts, is within the breakaway torque.
struct StandingRotor {
  using Expansion = StandingSeries;
  enum class Event { none, released };

  double breakaway;     ///< Fs, N m
  double direction{0};  ///< of the torque on it at the end of the step: −1, 1

  static StandingSeries start() { return {}; }
  static double expand(StandingSeries& s, std::size_t k, double torque) {
    s.torque[k] = torque;
    return 0.0;
  }
  motion::NextEvent<Event> first_event(const StandingSeries& s, double step) const {
    motion::NextEvent<Event> next{step};
    for (const double sign : {1.0, -1.0}) {
      numerics::Series margin = s.torque;
      for (double& coefficient : margin) coefficient *= -sign;
      margin[0] += breakaway;
      if (margin[0] > 0.0) next.offer(motion::next_sign_change(margin, next.time), Event::released);
    }
    return next;
  }
  void go_to(const StandingSeries& s, const motion::NextEvent<Event>& next) {
    direction = numerics::sign_of(numerics::value_at(s.torque, next.time));
  }
};

}  // namespace

StandStep stand_step(double breakaway, double inertia, const motion::TorqueCourse& torque, double tolerance,
                     double duration) {
  StandingRotor rotor{breakaway};
  const auto next = motion::taylor_step(rotor, inertia, torque, tolerance, duration);
  return {next.time, next.event == StandingRotor::Event::released ? rotor.direction : 0.0};
}

}  // namespace zerocount::friction
