#include "tests/support/odeint_motion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

namespace zerocount::testing {

namespace {

using Real = OdeintMotion::Real;

constexpr Real position_tolerance = 1e-18L;  // local error of one step, rad
constexpr Real velocity_tolerance = 1e-15L;  // local error of one step, rad/s
constexpr Real relative_tolerance = 1e-17L;

Real profile_value(const Profile& profile, Real angle) {
  Real field = 0;
  for (std::size_t m = 0; m < profile.cosine.size(); ++m) {
    const Real turn = static_cast<Real>(m) * angle;
    field += profile.cosine[m] * std::cos(turn) + profile.sine[m] * std::sin(turn);
  }
  const Real value = profile.location + profile.scale * field;
  return profile.marginal == Marginal::lognormal ? std::exp(value) : value;
}

}  // namespace

OdeintMotion::OdeintMotion(const TrialParameters& parameters)
    : plant_(parameters.plant), friction_(parameters.friction), position_(parameters.initial.position) {
  contact_ = contact_at(0);
  frequency_ = std::sqrt((contact_.k1 + contact_.k2) / plant_.inertia);
  state_[3] = parameters.initial.hardening;
  const Real preload = parameters.initial.preload;
  if (preload != 0) {
    const int side = sign(preload);
    const Real turn = side * inverse_branch(2 * std::abs(preload)) / 2;
    stack_.emplace_back(turn, preload);
    offset_ = turn - side * inverse_branch(std::abs(preload));
    direction_ = -side;
  }
}

OdeintMotion::Contact OdeintMotion::contact_at(Real theta) const {
  FrictionParameters p = friction_.uniform;
  for (const ProfiledParameter& entry : friction_.profiled) {
    p.*entry.parameter = static_cast<double>(profile_value(*entry.profile, position_ + theta));
  }
  return {p.k1, p.k2, p.beta, p.alpha, p.lambda, p.n, p.breakaway, p.coulomb_ratio, p.stribeck_velocity};
}

Real OdeintMotion::branch(Real u) const {
  return contact_.k1 * u - contact_.k2 / contact_.beta * std::expm1(-contact_.beta * u);
}

Real OdeintMotion::branch_slope(Real u) const {
  return contact_.k1 + contact_.k2 * std::exp(-contact_.beta * u);
}

Real OdeintMotion::inverse_branch(Real torque) const {
  Real low = 0;
  Real high = torque / contact_.k1;
  for (int halving = 0; halving < 200 && low < high; ++halving) {
    const Real middle = (low + high) / 2;
    if (middle == low || middle == high) break;
    (branch(middle) < torque ? low : high) = middle;
  }
  return high;
}

Real OdeintMotion::spring_torque(const State& y) const {
  const Real x = elongation(y);
  if (stack_.empty()) return virgin_sign_ * branch(2 * virgin_sign_ * x) / 2;
  return stack_.back().second + direction_ * branch(direction_ * (x - stack_.back().first));
}

Real OdeintMotion::stiffness(const State& y) const {
  const Real x = elongation(y);
  return stack_.empty() ? branch_slope(2 * virgin_sign_ * x)
                        : branch_slope(direction_ * (x - stack_.back().first));
}

Real OdeintMotion::driving(Real sigma) const {
  const Real size = std::abs(sigma);
  const Real power = contact_.n == 2 ? size * size : contact_.n == 1 ? size : std::pow(size, contact_.n);
  return power / contact_.lambda;
}

Real OdeintMotion::hardening_rate(const State& y, Real sigma) const {
  return creeping_ ? contact_.alpha * (driving(sigma) - y[3]) : 0;
}

OdeintMotion::State OdeintMotion::slopes(const State& y) const {
  if (sliding_) {
    const Real coulomb = contact_.coulomb_ratio * contact_.breakaway;
    const Real w = y[1] / contact_.stribeck_velocity;
    const Real level = coulomb + (contact_.breakaway - coulomb) * std::exp(-w * w);
    return {y[1], (torque_ - plant_.sliding_damping * y[1] - direction_ * level) / plant_.inertia, 0, 0};
  }
  const Real sigma = spring_torque(y);
  const Real hardening = hardening_rate(y, sigma);
  return {y[1], (torque_ - plant_.presliding_damping * y[1] - sigma) / plant_.inertia,
          sign(sigma) * hardening, hardening};
}

Real OdeintMotion::elongation_acceleration(const State& y) const {
  const Real sigma = spring_torque(y);
  const Real acceleration = (torque_ - plant_.presliding_damping * y[1] - sigma) / plant_.inertia;
  if (!creeping_ || sigma == 0) return acceleration;
  const Real hardening = hardening_rate(y, sigma);
  const Real rate = y[1] - sign(sigma) * hardening;
  const Real growth = contact_.n * driving(sigma) / std::abs(sigma) * sign(sigma) * stiffness(y) * rate;
  return acceleration - sign(sigma) * contact_.alpha * (growth - hardening);
}

OdeintMotion::State OdeintMotion::state_after(Real time) const {
  boost::numeric::odeint::runge_kutta_fehlberg78<State, Real, State, Real> stepper;
  State end{};
  stepper.do_step([this](const State& y, State& dydt, Real) { dydt = slopes(y); }, state_, Real{0}, end,
                  time);
  return end;
}

Real OdeintMotion::longest_step() const {
  if (!sliding_) return 0.25L / frequency_;
  const Real speed = std::abs(state_[1]);
  const Real steepest =
      (std::abs(torque_) + contact_.breakaway + plant_.sliding_damping * speed) / plant_.inertia;
  // Beyond seven Stribeck velocities the peak, exp(−49), is out of sight.
  return std::max(speed - 7 * contact_.stribeck_velocity, contact_.stribeck_velocity / 8) / steepest;
}

void OdeintMotion::advance(Real torque, Real duration) {
  torque_ = torque;
  settle();
  boost::numeric::odeint::runge_kutta_fehlberg78<State, Real, State, Real> stepper;
  const auto system = [this](const State& y, State& dydt, Real) { dydt = slopes(y); };
  Real remaining = duration;
  while (remaining > 0 && !frozen_) {
    const Real longest = longest_step();
    Real length = std::min(step_ > 0 ? step_ : longest, longest);
    if (length >= remaining * 0.999L) length = remaining;
    State end{};
    State error{};
    stepper.do_step(system, state_, Real{0}, end, length, error);
    Real worst = 0;
    for (std::size_t j = 0; j < error.size(); ++j) {
      const Real allowed =
          (j == 1 ? velocity_tolerance : position_tolerance) + relative_tolerance * std::abs(end[j]);
      const Real share = std::abs(error[j]) / allowed;
      worst = share <= worst ? worst : std::isfinite(share) ? share : 1e12L;
    }
    const Real growth = 0.9L * std::pow(std::max(worst, 1e-8L), -0.125L);
    step_ = length * std::clamp(growth, 0.1L, 3.0L);
    if (worst > 1) {
      if (step_ < duration * 1e-14L) throw std::runtime_error("odeint_trial: the step does not converge");
      continue;
    }
    const Crossing crossing = first_crossing(end, length);
    if (crossing.event == event_count) {
      state_ = end;
      remaining -= length;
      continue;
    }
    state_ = state_after(crossing.time);
    remaining -= crossing.time;
    happen(crossing.event);
  }
}

}  // namespace zerocount::testing
