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

Real profile_value(const friction::Profile& profile, Real angle) {
  Real field = 0;
  for (std::size_t m = 0; m < profile.cosine.size(); ++m) {
    const Real turn = static_cast<Real>(m) * angle;
    field += profile.cosine[m] * std::cos(turn) + profile.sine[m] * std::sin(turn);
  }
  const Real value = profile.location + profile.scale * field;
  return profile.marginal == friction::Marginal::lognormal ? std::exp(value) : value;
}

}  // namespace

OdeintMotion::OdeintMotion(const trial::TrialParameters& parameters, const std::vector<double>& history)
    : plant_(parameters.plant), friction_(parameters.friction), position_(parameters.initial.position) {
  contact_ = contact_at(0);
  frequency_ = std::sqrt((contact_.k1 + contact_.k2) / plant_.inertia);
  coulomb_ = friction_.model == friction::FrictionModel::coulomb;
  state_[1] = parameters.initial.velocity;
  const bool slides = parameters.initial.mode == trial::InitialMode::slide || coulomb_;
  if (slides && state_[1] != 0) {
    sliding_ = true;
    direction_ = sign(state_[1]);
    if (!coulomb_) held_torque_ = direction_ * contact_.breakaway;
  } else if (!coulomb_) {
    state_[3] = parameters.initial.hardening;
    std::vector<double> torques{parameters.initial.preload, 0.0};
    torques.insert(torques.end(), history.begin(), history.end());
    torques.push_back(0.0);
    stretch(torques);
  }
}

/// Brings the spring to its state after it was loaded, from the virgin state, to these torques in turn. No
/// spring is simulated; the wiping-out rule is applied to the sequence: what is remembered are the last
/// torque of the largest magnitude, and after it alternately the last lowest and the last highest (Mayergoyz,
/// "Mathematical Models of Hysteresis", section I.2: the alternating series of dominant extrema).
void OdeintMotion::stretch(const std::vector<double>& torques) {
  std::size_t at = 0;
  for (std::size_t i = 0; i < torques.size(); ++i) {
    if (std::abs(torques[i]) >= std::abs(torques[at])) at = i;
  }
  if (torques[at] == 0.0) return;
  const int side = sign(torques[at]);
  Real x = side * inverse_branch(2 * std::abs(static_cast<Real>(torques[at]))) / 2;
  int towards = -side;
  while (at + 1 < torques.size()) {
    std::size_t extreme = at + 1;
    for (std::size_t i = extreme; i < torques.size(); ++i) {
      if (towards * torques[i] >= towards * torques[extreme]) extreme = i;
    }
    stack_.emplace_back(x, torques[at]);
    x += towards * inverse_branch(std::abs(static_cast<Real>(torques[extreme]) - torques[at]));
    direction_ = towards;
    towards = -towards;
    at = extreme;
  }
  offset_ = x;
}

OdeintMotion::Contact OdeintMotion::contact_at(Real theta) const {
  friction::FrictionParameters p = friction_.uniform;
  for (const friction::ProfiledParameter& entry : friction_.profiled)
    p.*entry.parameter = static_cast<double>(profile_value(*entry.profile, position_ + theta));
  if (friction_.model == friction::FrictionModel::spring) p.alpha = 0.0;
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

Real OdeintMotion::torque_at(Real time) const {
  if (torque_.rate == 0 || torque_.now == torque_.settled) return torque_.now;
  return torque_.settled + (torque_.now - torque_.settled) * std::exp(-torque_.rate * (clock_ + time));
}

OdeintMotion::State OdeintMotion::slopes(const State& y, Real time) const {
  const Real torque = torque_at(time);
  if (sliding_) {
    const Real coulomb = contact_.coulomb_ratio * contact_.breakaway;
    const Real w = y[1] / contact_.stribeck_velocity;
    const Real level = coulomb + (contact_.breakaway - coulomb) * std::exp(-w * w);
    return {y[1], (torque - plant_.sliding_damping * y[1] - direction_ * level) / plant_.inertia, 0, 0};
  }
  const Real sigma = spring_torque(y);
  const Real hardening = hardening_rate(y, sigma);
  return {y[1], (torque - plant_.presliding_damping * y[1] - sigma) / plant_.inertia, sign(sigma) * hardening,
          hardening};
}

Real OdeintMotion::elongation_acceleration(const State& y) const {
  const Real sigma = spring_torque(y);
  const Real acceleration = (torque_at(0) - plant_.presliding_damping * y[1] - sigma) / plant_.inertia;
  if (!creeping_ || sigma == 0) return acceleration;
  const Real hardening = hardening_rate(y, sigma);
  const Real rate = y[1] - sign(sigma) * hardening;
  const Real growth = contact_.n * driving(sigma) / std::abs(sigma) * sign(sigma) * stiffness(y) * rate;
  return acceleration - sign(sigma) * contact_.alpha * (growth - hardening);
}

OdeintMotion::State OdeintMotion::state_after(Real time) const {
  boost::numeric::odeint::runge_kutta_fehlberg78<State, Real, State, Real> stepper;
  State end{};
  stepper.do_step([this](const State& y, State& dydt, Real t) { dydt = slopes(y, t); }, state_, Real{0}, end,
                  time);
  return end;
}

Real OdeintMotion::longest_step() const {
  const Real longest = longest_step_at_constant_torque();
  // Fehlberg's error estimate does not see what depends on time alone.
  const bool moving = std::abs(torque_at(0) - torque_.settled) > 1e-20L;
  return moving ? std::min(longest, 0.25L / torque_.rate) : longest;
}

Real OdeintMotion::longest_step_at_constant_torque() const {
  if (!sliding_) return 0.25L / frequency_;
  const Real speed = std::abs(state_[1]);
  const Real steepest = (std::max(std::abs(torque_.now), std::abs(torque_.settled)) + contact_.breakaway +
                         plant_.sliding_damping * speed) /
                        plant_.inertia;
  // Beyond seven Stribeck velocities the peak, exp(−49), is out of sight.
  return std::max(speed - 7 * contact_.stribeck_velocity, contact_.stribeck_velocity / 8) / steepest;
}

void OdeintMotion::advance(const Torque& torque, Real duration) {
  torque_ = torque;
  clock_ = 0;
  settle();
  boost::numeric::odeint::runge_kutta_fehlberg78<State, Real, State, Real> stepper;
  const auto system = [this](const State& y, State& dydt, Real t) { dydt = slopes(y, t); };
  while (clock_ < duration && !frozen_) {
    const Real remaining = duration - clock_;
    if (coulomb_ && !sliding_) {
      const Real standing = standing_time(remaining);
      if (standing >= remaining) return;
      clock_ += standing;
      break_away(sign(torque_at(0)));
      continue;
    }
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
      const Real proportion = std::abs(error[j]) / allowed;
      worst = proportion <= worst ? worst : std::isfinite(proportion) ? proportion : 1e12L;
    }
    const Real growth = 0.9L * std::pow(std::max(worst, 1e-8L), -0.125L);
    step_ = length * std::clamp(growth, 0.1L, 3.0L);
    if (worst > 1) {
      if (step_ < duration * 1e-14L) throw std::runtime_error("odeint_motion: the step does not converge");
      continue;
    }
    const Crossing crossing = first_crossing(end, length);
    if (crossing.event == event_count) {
      state_ = end;
      clock_ = length == remaining ? duration : clock_ + length;
      continue;
    }
    state_ = state_after(crossing.time);
    clock_ += crossing.time;
    happen(crossing.event);
  }
}

}  // namespace zerocount::testing
