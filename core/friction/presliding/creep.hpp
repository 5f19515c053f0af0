#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/friction/parameters.hpp"
#include "core/motion/parameters.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::friction {

/// The plastic module (paper, eq. 2): creep with work hardening,
///
///   dxh/dt = α·max(|σ|ⁿ/λ − xh, 0),   dxp/dt = sgn(σ)·dxh/dt.
struct CreepState {
  double extension{0.0};  ///< xp, rad
  double hardening{0.0};  ///< xh, rad
};

/// |σ|ⁿ, (N m)ⁿ. The usual n = 2 needs no pow().
inline double torque_power(const FrictionParameters& friction, double torque) {
  return friction.n == 2.0 ? torque * torque : numerics::pow(std::abs(torque), friction.n);
}

/// |σ|ⁿ/λ: the hardening (rad) at which creep under the torque σ (N m) ends.
inline double hardening_limit(const FrictionParameters& friction, double torque) {
  return torque_power(friction, torque) / friction.lambda;
}

/// The |σ| (N m) whose hardening limit is `hardening` (rad).
inline double torque_of_limit(const FrictionParameters& friction, double hardening) {
  const double power = friction.lambda * hardening;
  return friction.n == 2.0 ? std::sqrt(power) : numerics::pow(power, 1.0 / friction.n);
}

/// The |σ| (N m) beyond which creep goes on in a contact hardened to `hardening` (rad); infinite where α is
/// 0. Never below 1e-14 of the breakaway torque, because the sign of a smaller σ is a matter of rounding.
inline double creep_onset_torque(const FrictionParameters& friction, double hardening) {
  if (friction.alpha == 0.0) return std::numeric_limits<double>::infinity();
  return std::max(torque_of_limit(friction, hardening), 1e-14 * friction.breakaway);
}

/// The |σ| (N m) at which creep that has ended sets in again. It lies beyond the limit of `hardening` (rad),
/// and beyond the present σ = `torque` at `elongation` (rad) by its rounding error. Without the second
/// condition, creep would set in again at once if σ changes by less than its rounding error per step.
inline double creep_onset_after_end(const FrictionParameters& friction, double hardening, double torque,
                                    double elongation) {
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() *
                          (std::abs(torque) + (friction.k1 + friction.k2) * std::abs(elongation));
  return std::max(creep_onset_torque(friction, hardening), std::abs(torque) + rounding);
}

/// The exact state after `duration` (s) at the constant torque σ (N m): xh relaxes to its limit as exp(−αt).
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
  double balance{0.0};  ///< U, N m
  double sign{1.0};     ///< s
  double g1{0.0};       ///< 1/s
  double g2{0.0};       ///< 1/rad
  double s1{0.0};       ///< N m s/rad
  double s2{0.0};       ///< N m s²/rad²
  double w1{0.0};       ///< dimensionless
  double w2{0.0};       ///< s/rad
  double rate{0.0};     ///< Rate of creep p₀ at t = 0, rad/s
};

/// Creep at rest with `sign`·torque > 0. Empty if creep is too fast: α must be below a tenth of the rates at
/// which the motion of the rotor decays, c/2J and k/c.
/// @param torque u, N m. @param sign s. @param stiffness k, N m/rad. @param hardening xh at t = 0, rad, with
/// |u|ⁿ/λ beyond it.
std::optional<CreepAtRest> creep_at_rest(const motion::PlantParameters& plant,
                                         const FrictionParameters& contact, double torque, double sign,
                                         double stiffness, double hardening);

/// Error bound of θ (rad): twice the contributions of p³, the first neglected power, and of the change of the
/// tangent stiffness from k to `last_stiffness` (N m/rad, at most k) while S goes to U.
double error_of_creep_at_rest(const CreepAtRest& rest, const motion::PlantParameters& plant,
                              const FrictionParameters& contact, double stiffness, double last_stiffness);

/// Rate of creep p (rad/s) after the time t (s).
double creep_rate_after(const CreepAtRest& rest, double t);

/// ∫p dt (rad), the growth of xh and |xp| until the rate has fallen to `rate` (rad/s).
double creep_until_rate(const CreepAtRest& rest, double rate);

/// The rate (rad/s) at which ∫p dt has become `growth` (rad): 0 or less where it never does.
double rate_after_creep(const CreepAtRest& rest, double growth);

/// The time (s) until the rate has fallen to `rate` (rad/s, positive).
double time_until_rate(const CreepAtRest& rest, double rate);

/// Spring torque S (N m) at the rate of creep p (rad/s).
inline double spring_torque_at_rate(const CreepAtRest& rest, double rate) {
  return rest.balance - rate * (rest.s1 + rate * rest.s2);
}

/// Velocity w (rad/s) at the rate of creep p (rad/s).
inline double velocity_at_rate(const CreepAtRest& rest, double rate) {
  return rate * (rest.w1 + rate * rest.w2);
}

}  // namespace zerocount::friction
