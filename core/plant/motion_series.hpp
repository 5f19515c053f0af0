#pragma once

#include "core/friction/creep.hpp"
#include "core/friction/parameters.hpp"
#include "core/friction/spring.hpp"
#include "core/numerics/power_series.hpp"
#include "core/plant/parameters.hpp"
#include "core/plant/torque_course.hpp"

namespace zerocount {

/// Taylor series in time of the pre-sliding motion from the present state, on one branch.
struct PreslidingSeries {
  Series elongation;       ///< xs, rad
  Series elongation_rate;  ///< dxs/dt, rad/s
  Series omega;            ///< ω, rad/s
  Series extension;        ///< xp, rad
  Series hardening;        ///< xh, rad
  Series spring_torque;    ///< σ, N m
  Series creep_rate;  ///< α·(|σ|ⁿ/λ − xh), the rate of xh while creep is on, rad/s; zero while it is off
  Series exponent;  ///< −y, the exponent of the branch law, dimensionless
};

/// The solution of
///   J·dω/dt = u − c·ω − σ(xs),   dxs/dt = ω − dxp/dt,   dxh/dt = α·(|σ|ⁿ/λ − xh),   dxp/dt = sgn(σ)·dxh/dt
/// (paper, eqs. 1, 2 and 4, with creep kept) as power series, order by order. With y = softening_rate·|xs −
/// xr| the branch is σ = σr + s·[k1·|xs − xr| + softening_torque·(1 − exp(−y))], so that the only exponential
/// is that of y at the start.
/// @param torque u(t), N m. @param creeping whether the creep law is on.
PreslidingSeries presliding_series(const PlantParameters& plant, const FrictionParameters& contact,
                                   const HystereticSpring& spring, const CreepState& creep, double omega,
                                   const TorqueCourse& torque, bool creeping);

/// Taylor series in time of the sliding motion.
struct SlidingSeries {
  Series theta;     ///< θ, rad
  Series omega;     ///< ω, rad/s
  Series exponent;  ///< −(ω/ωs)², dimensionless
};

/// The solution of J·dω/dt = u − cs·ω − d·(Fc + (Fs − Fc)·exp(−(ω/ωs)²)), dθ/dt = ω (paper, eq. 3, with
/// Stribeck friction).
/// @param direction d, −1 or 1. @param torque u(t), N m.
SlidingSeries sliding_series(const PlantParameters& plant, const FrictionParameters& contact, double theta,
                             double omega, double direction, const TorqueCourse& torque);

/// The longest step t ≤ `longest` (s) over which both hold:
/// - the last two terms of the series of a position, and those of its velocity times t, stay below
/// `tolerance`·t/longest
///   (rad), so that the steps of a whole interval leave out no more than `tolerance`. Two terms, because one
///   may vanish by chance;
/// - the exponent of the motion's one exponential grows by at most 6, or stays below −40. The terms zᵏ/k! of
/// exp(z) rise up to
///   k = z: beyond that growth the last terms kept may be small before the largest have come.
/// The exp(−rt) of a torque that moves needs no such bound: where rt exceeds the order of the series, the
/// last terms are the largest of all, and a step over which they are small is one over which all of it is.
double step_within(const Series& position, const Series& velocity, const Series& exponent, double tolerance,
                   double longest);

}  // namespace zerocount
