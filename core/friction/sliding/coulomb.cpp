#include "core/friction/sliding/coulomb.hpp"

#include <cmath>
#include <utility>

#include "core/friction/sliding/standing.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::friction {

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
  Slide slide{contact_, plant_.sliding_damping, theta_, omega_, direction_, std::exchange(at_level_, false)};
  const SlideStep step = slide_step(slide, plant_.inertia, torque, tolerance_, duration);
  theta_ = slide.theta;
  omega_ = slide.omega;
  if (step.ended) stand_still();
  return step.time;
}

void CoulombFriction::stand_still() {
  contact_ = friction_at(friction_, position_ + theta_, ++contact_number_);
  omega_ = 0.0;
  sliding_ = false;
  spent_ = leads_nowhere(slide_start_, theta_, tolerance_);
}

void CoulombFriction::set_motion(const CoulombMotion& motion) {
  theta_ = motion.theta;
  omega_ = motion.omega;
  sliding_ = motion.direction != 0.0;
  if (sliding_) direction_ = motion.direction;
  spent_ = motion.spent;
}

bool CoulombFriction::torque_drives(double direction, const motion::TorqueCourse& torque) const {
  return leaves_rest({contact_, plant_.sliding_damping, 0.0, 0.0, direction}, plant_.inertia, torque);
}

/// Lets the rotor stand under the torque for at most `duration` (s), and starts a slide when |u| passes the
/// breakaway torque. It can do so at most once, and only towards the value at which u settles, because u is
/// monotonic. An excess of torque too small to change ω in rounding does not start a slide: otherwise the
/// rotor would slide and stick without end.
/// @returns the time used, s.
double CoulombFriction::stand(const motion::TorqueCourse& torque, double duration) {
  if (motion::is_coupled(torque)) return stand_coupled(torque, duration);
  const double torque_now = motion::torque_on_rotor(torque, 0.0);
  const int towards = numerics::sign_of(torque_now);
  if (std::abs(torque_now) > contact_.breakaway && torque_drives(towards, torque)) {
    break_away(towards);
    return 0.0;
  }
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
  const StandingContact contact{contact_.breakaway, plant_.inertia, std::exchange(spent_, false)};
  const StandStep step = stand_step(contact, torque, tolerance_, duration);
  if (step.direction != 0.0) break_away(step.direction, step.at_level);
  return step.time;
}

void CoulombFriction::break_away(double direction, bool at_level) {
  direction_ = direction;
  at_level_ = at_level;
  slide_start_ = theta_;
  sliding_ = true;
  ++breakaways_;
}

}  // namespace zerocount::friction
