#include "tests/benchmarks/peers/contact.hpp"

#include <cmath>
#include <limits>

#include "core/friction/presliding/creep.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::testing {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// Fraction of the breakaway torque below which the sign of σ is due to rounding (as in core/plant).
constexpr double torque_without_sign = 1e-14;

/// Relative rounding error of the difference of two equal velocities.
constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();

}  // namespace

PeerContact::PeerContact(const trial::TrialParameters& p)
    : plant_(p.plant),
      friction_(p.friction),
      position_(p.initial.position),
      contact_(friction::friction_at(p.friction, position_)),
      spring_(contact_),
      hardening_at_anchor_(p.initial.hardening) {
  spring_.start_preloaded(p.initial.preload);
  hook_ = -spring_.elongation();
  adopt_contact(contact_);
  deepest_ = depth();
}

void PeerContact::adopt_contact(const friction::FrictionParameters& friction) {
  contact_ = friction;
  frequency_ = std::sqrt((contact_.k1 + contact_.k2) / plant_.inertia);
  law_.sliding = false;
  law_.per_tau = frequency_;
  law_.tau_per_inertia = 1.0 / (frequency_ * plant_.inertia);
  law_.damping = plant_.presliding_damping;
  law_.k1 = contact_.k1;
  law_.per_lambda = 1.0 / contact_.lambda;
  law_.n = contact_.n;
  law_.alpha = 0.0;
  creep_onset_torque_ = friction::creep_onset_torque(contact_, hardening_at_anchor_ + rest_limit);
  rest_duration_ = 0.0;
  adopt_branch();
}

void PeerContact::adopt_branch() {
  const friction::SpringBranch& branch = spring_.branch();
  law_.anchor = branch.elongation;
  law_.anchor_torque = branch.torque;
  law_.sign = branch.sign;
  law_.softening_torque = branch.softening_torque;
  law_.softening_rate = branch.softening_rate;
  direction_ = spring_.direction();
  branch_end_ = spring_.branch_end().value_or(direction_ * never);
}

void PeerContact::begin(PeerState& y) {
  for (;;) {
    resting_ = false;
    if (sliding()) {
      const bool leaves = law_.sign * law_.torque > contact_.breakaway;
      if (y[1] != 0.0 || leaves) return;
      re_stick(y);
    }
    const double sigma = law_.spring_torque(y[0]);
    const double creep = creep_rate(sigma, y);
    const double omega = this->omega(y);
    const double rate = omega - creep;
    const double unbalanced = law_.torque - law_.damping * omega - sigma;
    const double acceleration = unbalanced / plant_.inertia + law_.alpha * creep;  // where rate is 0
    resting_ = std::abs(rate) < rest_limit * frequency_ &&
               std::abs(acceleration) < rest_limit * frequency_ * frequency_;
    rest_torque_ = sigma;
    if (resting_) return;
    const double motion = omega != 0.0 ? omega : unbalanced;
    const double hook_torque = sigma + law_.damping * omega;
    if (std::abs(hook_torque) >= contact_.breakaway && hook_torque * motion > 0.0) {
      break_away(numerics::sign_of(motion), y);
      continue;
    }
    const bool turns = std::abs(rate) <= rounding * std::abs(omega);
    return adopt_direction(numerics::sign_of(turns ? acceleration : rate), y);
  }
}

/// Rate of creep dxp/dt, rad/s, at the spring torque σ from now on.
double PeerContact::creep_rate(double sigma, const PeerState& y) {
  if (law_.alpha == 0.0 && std::abs(sigma) >= creep_onset_torque_) start_creep(sigma, y);
  if (law_.alpha == 0.0) return 0.0;
  const double growth = law_.alpha * (law_.hardening_limit(sigma) - y[2]);
  if (growth > 0.0 && sigma * law_.side > 0.0) return law_.side * growth;
  end_creep(y);
  return 0.0;
}

void PeerContact::adopt_direction(int direction, const PeerState& y) {
  if (direction == spring_.direction()) return;
  spring_.move_on_branch(y[0]);
  spring_.set_direction(direction);
  deepest_ = std::max(deepest_, depth());
  adopt_branch();
}

void PeerContact::hold(PeerState& y, double duration) {
  if (law_.alpha == 0.0) {
    y[1] = 0.0;
    return;
  }
  if (duration != rest_duration_) {
    rest_duration_ = duration;
    rest_relaxation_ = -std::expm1(-contact_.alpha * duration);
  }
  const double remaining = law_.hardening_limit(rest_torque_) - y[2];
  const double growth = remaining * rest_relaxation_;
  y[2] += growth;
  y[1] = law_.side * law_.alpha * (remaining - growth) / law_.per_tau;
}

void PeerContact::start_creep(double sigma, const PeerState& y) {
  extension_at_anchor_ = extension(y);
  hardening_at_anchor_ = y[2];
  law_.alpha = contact_.alpha;
  law_.side = numerics::sign_of(sigma);
}

void PeerContact::end_creep(const PeerState& y) {
  extension_at_anchor_ = extension(y);
  hardening_at_anchor_ = y[2];
  law_.alpha = 0.0;
  creep_onset_torque_ = friction::creep_onset_torque(contact_, y[2] + rest_limit);
}

void PeerContact::happen(PeerEvent event, PeerState& y) {
  if (event == PeerEvent::closure) y[0] = branch_end_;
  if (!sliding()) spring_.move_on_branch(y[0]);
  switch (event) {
    case PeerEvent::reversal: {
      const double growth = law_.alpha * (law_.hardening_limit(law_.spring_torque(y[0])) - y[2]);
      y[1] = law_.side * growth / law_.per_tau;  // dxs/dt is zero here
      break;
    }
    case PeerEvent::closure:
      adopt_branch();
      break;
    case PeerEvent::creep:
      if (law_.alpha == 0.0) {
        start_creep(law_.spring_torque(y[0]), y);
      } else {
        end_creep(y);
      }
      break;
    case PeerEvent::breakaway:
      break_away(numerics::sign_of(y[1]), y);
      break;
    case PeerEvent::stop:
      y[1] = 0.0;
      re_stick(y);
      break;
    case PeerEvent::none:
      break;
  }
}

void PeerContact::break_away(double direction, PeerState& y) {
  const double sigma = law_.spring_torque(y[0]);
  breakaway_spring_torque_ = std::abs(sigma) < torque_without_sign * contact_.breakaway ? 0.0 : sigma;
  extension_at_anchor_ = extension(y);
  hardening_at_anchor_ = y[2];
  y = {hook_ + y[0] + extension_at_anchor_, y[1], 0.0};
  law_.sliding = true;
  law_.sign = direction;
  law_.damping = plant_.sliding_damping;
  law_.coulomb = contact_.coulomb_ratio * contact_.breakaway;
  law_.softening_torque = contact_.breakaway - law_.coulomb;
  law_.softening_rate = law_.per_tau / contact_.stribeck_velocity;
  ++breakaways_;
}

/// Begins a new contact, at rest at the present rotor angle θ = y[0].
void PeerContact::re_stick(PeerState& y) {
  contact_ = friction::friction_at(friction_, position_ + y[0]);
  spring_ = friction::HystereticSpring(contact_);
  spring_.start_virgin(friction::virgin_elongation(contact_, breakaway_spring_torque_),
                       numerics::sign_of(law_.sign));
  hook_ = y[0] - spring_.elongation();
  extension_at_anchor_ = hardening_at_anchor_ = 0.0;
  adopt_contact(contact_);
  y = {spring_.elongation(), 0.0, 0.0};
}

}  // namespace zerocount::testing
