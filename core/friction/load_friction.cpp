#include "core/friction/load_friction.hpp"

#include <cmath>

#include "core/friction/bristles/bristle.hpp"
#include "core/friction/bristles/bristle_formulas.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::friction {
namespace {

/// Direction in which a second mass at rest begins to move, −1 or 1, from the series of its velocity; 0 if it
/// stays at rest.
double heading_from_rest(const numerics::Series& omega) {
  for (const double coefficient : omega)
    if (coefficient != 0.0) return numerics::sign_of(coefficient);
  return 0.0;
}

}  // namespace

CoulombOnLoad::CoulombOnLoad(const FrictionParameters& contact, double inertia, double velocity)
    : contact_(contact),
      inertia_(inertia),
      omega_(velocity),
      sliding_(velocity != 0.0),
      direction_(numerics::sign_of(velocity)) {}

void CoulombOnLoad::start(const motion::Load& load) {
  omega_ = load.omega;
  vibration_ = &load.disturbance;
  standing_series_ = {};
  if (sliding_) sliding_series_ = slide().start();
}

double CoulombOnLoad::expand(const numerics::Series& omega, double torque, std::size_t k) {
  if (!sliding_) return StandingRotor::expand(standing_series_, k, torque);
  // Another torque than that of breakaway has set in since, where a contact of the coupling began or ended.
  constexpr double same_level = 1e-6;
  if (k == 0 && std::abs(direction_ * torque - contact_.breakaway) > same_level * contact_.breakaway)
    at_level_ = false;
  sliding_series_.omega[k] = omega[k];
  return slide().expand(sliding_series_, k, torque);
}

double CoulombOnLoad::step_within(double tolerance, double duration) {
  tolerance_ = tolerance;
  if (!sliding_) return standing().step_of_state(standing_series_, tolerance, duration);
  const SlidingSeries& s = sliding_series_;
  return motion::step_within(s.position, s.omega, s.exponent, tolerance, duration);
}

std::optional<double> CoulombOnLoad::next_event(const numerics::Series& omega, double step) {
  if (!sliding_) {
    const auto next = standing().first_event(standing_series_, step);
    if (next.event == StandingRotor::Event::none) return std::nullopt;
    at_level_ = next.event == StandingRotor::Event::at_level;
    return next.time;
  }
  if (omega[0] == 0.0 && heading_from_rest(omega) != direction_) return 0.0;
  return motion::next_sign_change(omega, step);
}

void CoulombOnLoad::go_to(double time, bool at_event, motion::Load& load) {
  if (!sliding_) {
    spent_ = spent_ && time == 0.0;
    if (!at_event) return;
    direction_ = numerics::sign_of(numerics::value_at(standing_series_.torque, time));
    sliding_ = true;
    travel_ = 0.0;
    return;
  }
  travel_ += numerics::value_at(sliding_series_.position, time);
  at_level_ = at_level_ && time == 0.0;
  if (!at_event) return;
  load.omega = 0.0;
  sliding_ = at_level_ = false;
  spent_ = leads_nowhere(0.0, travel_, tolerance_);
}

void BristleOnLoad::start(const motion::Load& load) {
  omega_ = load.omega;
  if (omega_ != 0.0) direction_ = numerics::sign_of(omega_);
  const double end = direction_ * parameters_.level.coulomb / parameters_.stiffness;
  saturated_ = std::abs(omega_) > parameters_.fast &&
               is_at_end(deflection_, end, parameters_.level.coulomb, inertia_, omega_);
  if (saturated_) deflection_ = end;
  series_ = motion().start();
}

double BristleOnLoad::expand(const numerics::Series& omega, double torque, std::size_t k) {
  series_.omega[k] = omega[k];
  return motion().expand(series_, k, torque);
}

double BristleOnLoad::step_within(double tolerance, double duration) {
  return BristleMotion::step_of_state(series_, tolerance, duration);
}

std::optional<double> BristleOnLoad::next_event(const numerics::Series& omega, double step) {
  next_ = BristleMotion::Event::none;
  if (omega[0] == 0.0 && heading_from_rest(omega) == -direction_) return 0.0;
  series_.omega = omega;
  const auto next = motion().first_event(series_, step);
  next_ = next.event;
  if (next_ == BristleMotion::Event::none) return std::nullopt;
  return next.time;
}

void BristleOnLoad::go_to(double time, bool at_event, motion::Load& load) {
  if (at_event && next_ == BristleMotion::Event::none) {
    direction_ = -direction_;
    return;
  }
  motion().go_to(series_, {time, at_event ? next_ : BristleMotion::Event::none});
  if (at_event && next_ == BristleMotion::Event::velocity_zero) load.omega = 0.0;
}

FrictionOfLoad friction_of_load(const LoadFrictionParameters& friction, double inertia, double velocity) {
  const motion::PlantParameters no_damping{.presliding_damping = 0.0, .sliding_damping = 0.0};
  switch (friction.model) {
    case LoadFrictionModel::none:
      break;
    case LoadFrictionModel::coulomb:
      return CoulombOnLoad(friction.contact, inertia, velocity);
    case LoadFrictionModel::dahl:
      return BristleOnLoad(DahlFriction::bristle(no_damping, friction.contact), inertia);
    case LoadFrictionModel::lugre:
      return BristleOnLoad(LuGreFriction::bristle(no_damping, friction.contact), inertia);
  }
  return {};
}

}  // namespace zerocount::friction
