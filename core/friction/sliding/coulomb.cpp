#include "core/friction/sliding/coulomb.hpp"

#include <cmath>
#include <utility>

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

CoulombFriction::CoulombFriction(const motion::PlantParameters& plant, FrictionAlongRotor friction,
                                 const motion::PlantStart& start, const motion::MotionTolerance& tolerance)
    : plant_(plant),
      friction_(std::move(friction)),
      position_(start.position),
      tolerance_(tolerance.elongation),
      contact_(friction_at(friction_, position_)),
      omega_(start.velocity),
      sliding_(start.velocity != 0.0),
      direction_(numerics::sign_of(start.velocity)) {}

double CoulombFriction::step(const motion::TorqueCourse& torque, double duration) {
  return sliding_ ? slide(torque, duration) : stand(torque, duration);
}

double CoulombFriction::slide(const motion::TorqueCourse& torque, double duration) {
  Slide slide{contact_, plant_.sliding_damping, theta_, omega_, direction_};
  const SlideStep step = slide_step(slide, plant_.inertia, torque, tolerance_, duration);
  theta_ = slide.theta;
  omega_ = slide.omega;
  if (step.ended) {
    contact_ = friction_at(friction_, position_ + theta_, ++contact_number_);
    omega_ = 0.0;
    sliding_ = false;
  }
  return step.time;
}

bool CoulombFriction::torque_drives(double direction, const motion::TorqueCourse& torque) const {
  return leaves_rest({contact_, plant_.sliding_damping, 0.0, 0.0, direction}, plant_.inertia, torque);
}

/// |u| can pass the breakaway torque at most once, and only towards where it settles, because u is monotonic.
/// An excess of torque too small to change ω in rounding does not start a slide: otherwise the rotor would
/// slide and stick without end.
double CoulombFriction::stand(const motion::TorqueCourse& torque, double duration) {
  const double torque_now = motion::torque_on_rotor(torque, 0.0);
  const int towards = numerics::sign_of(torque_now);
  if (std::abs(torque_now) > contact_.breakaway && torque_drives(towards, torque)) {
    break_away(towards);
    return 0.0;
  }
  if (motion::is_coupled(torque)) return stand_coupled(torque, duration);
  if (motion::is_constant(torque) || std::abs(torque.settled) <= contact_.breakaway) return duration;
  const double direction = numerics::sign_of(torque.settled);
  // Starts at the level itself, so that rounding does not decide whether it is passed.
  const motion::TorqueCourse release{direction * contact_.breakaway, torque.settled, torque.rate};
  const double waiting = motion::time_until(torque, release.now);
  if (!(waiting < duration) || !torque_drives(direction, release)) return duration;
  break_away(direction);
  return waiting + slide(release, duration - waiting);
}

double CoulombFriction::stand_coupled(const motion::TorqueCourse& torque, double duration) {
  StandingRotor rotor{contact_.breakaway};
  const auto next = motion::taylor_step(rotor, plant_.inertia, torque, tolerance_, duration);
  if (next.event == StandingRotor::Event::released) break_away(rotor.direction);
  return next.time;
}

void CoulombFriction::break_away(double direction) {
  direction_ = direction;
  sliding_ = true;
  ++breakaways_;
}

}  // namespace zerocount::friction
