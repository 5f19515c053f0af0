#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/friction/parameters.hpp"
#include "core/motion/parameters.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::friction {

/// State of creep with work hardening, the plastic module of the contact (paper, eq. 2):
///
///   dxh/dt = α·max(|σ|ⁿ/λ − xh, 0),   dxp/dt = sgn(σ)·dxh/dt.
struct CreepState {
  double extension{0.0};  ///< Plastic extension xp by creep, rad
  double hardening{0.0};  ///< Hardening xh, rad
};

/// The power |σ|ⁿ (unit (N m)ⁿ) of the spring torque in the creep law; n is an exponent of `friction`. The
/// usual n = 2 needs no pow().
/// @param torque σ, N m.
inline double torque_power(const FrictionParameters& friction, double torque) {
  return friction.n == 2.0 ? torque * torque : numerics::pow(std::abs(torque), friction.n);
}

/// The hardening |σ|ⁿ/λ (rad) at which creep under the constant spring torque σ (N m) ends.
/// @param torque σ.
inline double hardening_limit(const FrictionParameters& friction, double torque) {
  return torque_power(friction, torque) / friction.lambda;
}

/// The absolute spring torque |σ| (N m) under which creep ends at the hardening `hardening` (rad). Inverse of
/// hardening_limit().
inline double torque_of_limit(const FrictionParameters& friction, double hardening) {
  const double power = friction.lambda * hardening;
  return friction.n == 2.0 ? std::sqrt(power) : numerics::pow(power, 1.0 / friction.n);
}

/// The absolute spring torque |σ| (N m) above which a contact hardened to `hardening` (rad) creeps; infinite
/// if α is 0. Never below 1e-14 of the breakaway torque, because the sign of a smaller σ is a matter of
/// rounding.
inline double creep_onset_torque(const FrictionParameters& friction, double hardening) {
  if (friction.alpha == 0.0) return std::numeric_limits<double>::infinity();
  return std::max(torque_of_limit(friction, hardening), 1e-14 * friction.breakaway);
}

/// The absolute spring torque |σ| (N m) at which creep that has just ended sets in again. It lies beyond the
/// limit that belongs to `hardening` (rad), and beyond the present σ = `torque` at `elongation` (rad) by its
/// rounding error. Without the second condition, creep would set in again at once if σ changes by less than
/// its rounding error per step.
inline double creep_onset_after_end(const FrictionParameters& friction, double hardening, double torque,
                                    double elongation) {
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() *
                          (std::abs(torque) + (friction.k1 + friction.k2) * std::abs(elongation));
  return std::max(creep_onset_torque(friction, hardening), std::abs(torque) + rounding);
}

/// The exact state of creep after `duration` (s) at the constant spring torque σ = `torque` (N m): the
/// hardening xh relaxes to its limit as exp(−αt).
inline CreepState creep_at_constant_torque(const FrictionParameters& friction, CreepState start,
                                           double torque, double duration) {
  const double remaining = hardening_limit(friction, torque) - start.hardening;
  if (!(remaining > 0.0)) return start;
  const double growth = -remaining * numerics::expm1(-friction.alpha * duration);
  return {start.extension + std::copysign(growth, torque), start.hardening + growth};
}

/// Quasi-static creep of the rotor under a constant torque u.
///
/// With s = sgn(σ), let S = |σ|, U = s·u, w = s·ω and p = dxh/dt ≥ 0. The oscillation of the rotor has ended.
/// p decays within about 1/α, far more slowly than the rotor oscillates, and determines the other quantities:
///
///   dp/dt = −(g1·p + g2·p²),   S = U − s1·p − s2·p²,   w = w1·p + w2·p².
///
/// The coefficients are those that satisfy, power by power of p,
///
///   S = U − c·w − J·dw/dt,   w = p + (dS/dt)/k,   dp/dt = α·(n·Sⁿ⁻¹·(dS/dt)/λ − p),
///
/// which are the paper's eqs. 4 and 2, with k the tangent stiffness of the spring. From the first line:
///
///   p/(g1 + g2·p) = p₀/(g1 + g2·p₀)·exp(−g1·t).
///
/// Without creep all coefficients are zero, and S = U.
struct CreepAtRest {
  double balance{0.0};  ///< Spring torque that balances the motor's torque, U = s·u, N m
  double sign{1.0};     ///< Sign s of the spring torque
  double g1{0.0};       ///< Linear coefficient g1 of dp/dt = −(g1·p + g2·p²), 1/s
  double g2{0.0};       ///< Quadratic coefficient g2 of dp/dt, 1/rad
  double s1{0.0};       ///< Linear coefficient s1 of the spring torque S = U − s1·p − s2·p², N m s/rad
  double s2{0.0};       ///< Quadratic coefficient s2 of the spring torque S, N m s²/rad²
  double w1{0.0};       ///< Linear coefficient w1 of the velocity w = w1·p + w2·p², dimensionless
  double w2{0.0};       ///< Quadratic coefficient w2 of the velocity w, s/rad
  double rate{0.0};     ///< Rate of creep p₀ at t = 0, rad/s
};

/// Computes quasi-static creep at rest under the torque u, with s·u > 0. Empty if creep is too fast: α must
/// be below a tenth of the rates at which the motion of the rotor decays, c/2J and k/c.
/// @param torque u, N m.
/// @param sign s, the sign of the spring torque.
/// @param stiffness tangent stiffness k of the spring, N m/rad.
/// @param hardening xh at t = 0, rad, below the limit |u|ⁿ/λ.
std::optional<CreepAtRest> creep_at_rest(const motion::PlantParameters& plant,
                                         const FrictionParameters& contact, double torque, double sign,
                                         double stiffness, double hardening);

/// Upper bound of the error of θ (rad) under quasi-static creep: twice the contributions of p³, the first
/// neglected power, and of the change of the tangent stiffness from k to `last_stiffness` (N m/rad, at most
/// k) while the spring torque S goes to U.
double error_of_creep_at_rest(const CreepAtRest& rest, const motion::PlantParameters& plant,
                              const FrictionParameters& contact, double stiffness, double last_stiffness);

/// Rate of creep p = dxh/dt (rad/s) at the time t (s) after the start of the rest.
double creep_rate_after(const CreepAtRest& rest, double t);

/// Growth ∫p dt (rad) of xh and |xp| until the rate of creep has fallen to `rate` (rad/s).
double creep_until_rate(const CreepAtRest& rest, double rate);

/// The rate of creep (rad/s) at which ∫p dt, the growth of xh and |xp|, has become `growth` (rad): 0 or less
/// if it never becomes as large.
double rate_after_creep(const CreepAtRest& rest, double growth);

/// The time (s) until the rate of creep has fallen to `rate` (rad/s, positive).
double time_until_rate(const CreepAtRest& rest, double rate);

/// Absolute spring torque S (N m) at the rate of creep p = `rate` (rad/s).
inline double spring_torque_at_rate(const CreepAtRest& rest, double rate) {
  return rest.balance - rate * (rest.s1 + rate * rest.s2);
}

/// Velocity w = s·ω of the rotor in the direction of creep (rad/s) at the rate of creep p = `rate` (rad/s).
inline double velocity_at_rate(const CreepAtRest& rest, double rate) {
  return rate * (rest.w1 + rate * rest.w2);
}

}  // namespace zerocount::friction
