#pragma once

#include "core/friction/parameters.hpp"
#include "core/friction/presliding/creep.hpp"
#include "core/friction/presliding/spring.hpp"
#include "core/motion/taylor_step.hpp"

namespace zerocount::friction {

/// Taylor series in time of the pre-sliding motion from the present state, on one hysteresis branch of the
/// spring.
struct StickingSeries {
  numerics::Series position{};         ///< Elongation xs of the spring, rad
  numerics::Series elongation_rate{};  ///< Elongation rate dxs/dt of the spring, rad/s
  numerics::Series omega{};            ///< Velocity ω of the rotor, rad/s
  numerics::Series extension{};        ///< Plastic extension xp by creep, rad
  numerics::Series hardening{};        ///< Hardening xh by creep, rad
  numerics::Series spring_torque{};    ///< Spring torque σ, N m
  numerics::Series creep_rate{};       ///< Rate of creep dxh/dt, rad/s; zero while creep is off
  numerics::Series exponent{};         ///< −y, the exponent of the branch law, dimensionless
  numerics::Series slope{};            ///< Rate −dy/dt of the branch law's exponent, 1/s
  numerics::Series softness{};         ///< Exponential exp(−y) of the branch law
  numerics::Series magnitude{};        ///< Absolute spring torque |σ|, N m
  numerics::Series power{};            ///< Power |σ|ⁿ of the spring torque in the creep law
  double torque_sign{1.0};             ///< Sign of the spring torque σ, which does not change while creep is
                                       /// < on
  double per_lambda{0.0};              ///< Reciprocal 1/λ of the hardening modulus of creep
};

/// The motion of the rotor while the friction contact sticks (paper, eqs. 1, 2 and 4, with creep kept):
///
///   J·dω/dt = u − c·ω − σ(xs),   dxs/dt = ω − dxp/dt,   dxh/dt = α·(|σ|ⁿ/λ − xh),   dxp/dt = sgn(σ)·dxh/dt.
///
/// With y = softening_rate·|xs − xr| the branch of the spring is σ = σr + s·[k1·|xs − xr| +
/// softening_torque·(1 − exp(−y))], so that the only exponential is that of y at the start of a step.
struct Sticking {
  using Expansion = StickingSeries;
  enum class Event {
    none,
    reversal,      ///< The elongation of the spring reverses its direction
    closure,       ///< The present hysteresis branch ends, and its minor loop closes
    creep_on,      ///< Creep starts: the absolute spring torque |σ| reaches its onset
    creep_off,     ///< Creep ends: the hardening has caught up with |σ|ⁿ/λ
    breakaway,     ///< The contact's torque reaches the breakaway torque, so that the contact starts to slide
    velocity_zero  ///< The rotor's velocity comes to ω = 0, which may start a slide in a contact already
                   /// < loaded beyond breakaway
  };

  const FrictionParameters& contact;
  double damping;  ///< Damping c between the rotor and the hook, the end of the friction spring that sticks,
                   /// < N m s/rad
  HystereticSpring& spring;
  CreepState& creep;
  double& omega;              ///< Velocity ω of the rotor, rad/s
  bool creeping;              ///< Whether the contact creeps
  double creep_onset_torque;  ///< Absolute spring torque |σ| at which creep starts while it is off, N m

  StickingSeries start() const;
  double expand(StickingSeries& s, std::size_t k, double torque) const {
    expand_torque(s, k);
    const double extension_rate = s.torque_sign * s.creep_rate[k];
    s.elongation_rate[k] = s.omega[k] - extension_rate;
    s.slope[k] = exponent_coefficient(s.elongation_rate[k]);
    s.hardening[k + 1] = s.creep_rate[k] * numerics::reciprocal[k + 1];
    s.extension[k + 1] = extension_rate * numerics::reciprocal[k + 1];
    s.position[k + 1] = s.elongation_rate[k] * numerics::reciprocal[k + 1];
    return torque - damping * s.omega[k] - s.spring_torque[k];
  }
  void complete(StickingSeries& series) const { expand_torque(series, numerics::series_order); }
  motion::NextEvent<Event> first_event(const StickingSeries& series, double step) const;
  void go_to(const StickingSeries& series, const motion::NextEvent<Event>& next);

 private:
  /// Taylor coefficient of the exponent −y of the hysteresis branch, given the same coefficient of the
  /// elongation xs.
  double exponent_coefficient(double elongation_coefficient) const {
    return -spring.branch().softening_rate * spring.branch().sign * elongation_coefficient;
  }

  /// Taylor coefficient k ≥ 1 of |σ|ⁿ, σ the spring torque. The whole exponents n = 1 and 2 need no division
  /// by σ, which may be tiny.
  /// @param magnitude, power series of |σ| and of |σ|ⁿ.
  static double torque_power_coefficient(const numerics::Series& magnitude, const numerics::Series& power,
                                         double n, std::size_t k) {
    if (n == 1.0) return magnitude[k];
    if (n == 2.0) return numerics::square_coefficient(magnitude.data(), k);
    return numerics::power_coefficient(magnitude.data(), power.data(), n, 1.0 / magnitude[0], k);
  }

  void expand_torque(StickingSeries& s, std::size_t k) const {
    const SpringBranch& branch = spring.branch();
    if (k > 0) {
      s.exponent[k] = exponent_coefficient(s.position[k]);
      s.softness[k] = numerics::exponential_coefficient(s.slope.data(), s.softness.data(), k);
      s.spring_torque[k] = branch.k1 * s.position[k] - branch.sign * branch.softening_torque * s.softness[k];
    }
    if (!creeping) return;
    s.magnitude[k] = s.torque_sign * s.spring_torque[k];
    if (k > 0) s.power[k] = torque_power_coefficient(s.magnitude, s.power, contact.n, k);
    // At k = 0 bitwise equal to hardening_limit(), so that dxs/dt is exactly zero at a reversal.
    const double limit = k == 0 ? s.power[0] / contact.lambda : s.power[k] * s.per_lambda;
    s.creep_rate[k] = contact.alpha * (limit - s.hardening[k]);
  }

  void find_closure(const StickingSeries& series, motion::NextEvent<Event>& next) const;
  void find_creep_change(const StickingSeries& series, motion::NextEvent<Event>& next) const;
  void find_breakaway(const StickingSeries& series, motion::NextEvent<Event>& next) const;
};

}  // namespace zerocount::friction
