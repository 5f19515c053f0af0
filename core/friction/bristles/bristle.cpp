#include "core/friction/bristles/bristle.hpp"

#include <cmath>

#include "core/numerics/sign.hpp"

namespace zerocount::friction {

BristleParameters bristle_parameters(double stiffness, double bristle_damping, double damping,
                                     const StribeckCurve& level) {
  const double velocity = level.excess != 0.0 ? 1.0 / std::sqrt(level.per_velocity_squared) : 0.0;
  return {{stiffness, bristle_damping, damping, level},
          fast_by_stribeck_velocity * velocity,
          slow_by_stribeck_velocity * velocity};
}

BristleSeries BristleMotion::start() const {
  BristleSeries s{};
  s.position[0] = theta;
  s.omega[0] = omega;
  s.deflection[0] = deflection;
  if (!has_constant_level()) s.decay[0] = decay_at(parameters.level, omega);
  return s;
}

double BristleMotion::expand(BristleSeries& s, std::size_t k, double torque) const {
  return has_constant_level() ? bristle_coefficient<true>(parameters, direction, saturated, s, k, torque)
                              : bristle_coefficient<false>(parameters, direction, saturated, s, k, torque);
}

motion::NextEvent<BristleMotion::Event> BristleMotion::first_event(const BristleSeries& series,
                                                                   double step) const {
  motion::NextEvent<Event> next{step};
  next.offer(motion::next_sign_change(series.omega, next.time), Event::velocity_zero);
  if (saturated && parameters.slow > 0.0) {
    numerics::Series above = series.omega;
    above[0] -= direction * parameters.slow;
    next.offer(motion::next_sign_change(above, next.time), Event::slow_again);
  }
  return next;
}

void BristleMotion::go_to(const BristleSeries& series, const motion::NextEvent<Event>& next) {
  theta = numerics::value_at(series.position, next.time);
  deflection = numerics::value_at(series.deflection, next.time);
  omega = next.event == Event::velocity_zero ? 0.0 : numerics::value_at(series.omega, next.time);
}

Bristle::Bristle(const BristleParameters& parameters, double inertia, const motion::PlantStart& start,
                 const motion::MotionTolerance& tolerance)
    : parameters_(parameters), inertia_(inertia), tolerance_(tolerance), omega_(start.velocity) {
  deflection_ = start.sliding
                    ? numerics::sign_of(omega_) * level_at(parameters.level, omega_) / parameters.stiffness
                    : start.holding / parameters.stiffness;
}

bool Bristle::sliding() const {
  return bristle_slides(parameters_, deflection_, omega_, level_at(parameters_.level, omega_));
}

/// Whether the rotor is fast and the bristle has reached the deflection of steady sliding, within rounding.
/// If so, sets z to that deflection.
/// @param direction direction of the motion, −1 or 1.
bool Bristle::saturates(double direction) {
  if (!(std::abs(omega_) > parameters_.fast)) return false;
  const double end = direction * parameters_.level.coulomb / parameters_.stiffness;
  if (!is_at_end(deflection_, end, parameters_.level.coulomb, inertia_, omega_)) return false;
  deflection_ = end;
  return true;
}

bool Bristle::rests_under(double torque) const {
  return bristle_rests(parameters_, deflection_, omega_, torque, inertia_, tolerance_.rest);
}

double Bristle::step(const motion::TorqueCourse& torque, double duration) {
  const bool constant = motion::is_steady(torque);
  if (constant && rest_torque_ == torque.now) return duration;
  rest_torque_.reset();
  const double direction = motion::heading_under(torque, omega_, parameters_.stiffness * deflection_);
  const bool quiet = motion::load_is_quiet(torque, omega_, inertia_, parameters_.stiffness * tolerance_.rest);
  if (constant && quiet && (direction == 0.0 || rests_under(torque.now))) {
    motion::let_load_follow(torque, 0.0);
    rest_torque_ = torque.now;
    omega_ = 0.0;
    deflection_ = torque.now / parameters_.stiffness;
    return duration;
  }
  BristleMotion motion{parameters_, direction, saturates(direction), theta_, omega_, deflection_};
  return motion::taylor_step(motion, inertia_, torque, tolerance_.elongation, duration).time;
}

}  // namespace zerocount::friction
