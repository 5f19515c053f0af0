#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/friction/parameters.hpp"
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

/// The |σ| (N m) at which creep that has ended sets in again: beyond the limit of `hardening` (rad), and
/// beyond the rounding error of the present σ = `torque` at `elongation` (rad); otherwise creep would set in
/// again at once where σ changes by less than that per step.
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

}  // namespace zerocount::friction
