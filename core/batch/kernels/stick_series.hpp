#pragma once

#include "core/batch/kernels/coupled_torque.hpp"
#include "core/batch/kernels/series.hpp"

namespace zerocount::batch {

/// Power series of the motion while the hook sticks, over one step of length h. Lengths are multiplied by
/// −s·(softening rate), with s = ±1 the side of the hysteresis branch, as in the branch's exponent.
template <class P>
struct StickSeries {
  P rate[batch_order + 1];           ///< Coefficients of dxs/dt·h, the rate of the spring's elongation; the
                                     ///< highest order leaves out creep.
  P scaled_creep[batch_order + 1];   ///< Coefficients of the creep xh·sgn(σ)
  P scaled_torque[batch_order + 1];  ///< Coefficients of the spring torque, σ·h²/J

  // Over the whole step.
  P elongation_change;
  P creep_change;
  P velocity_end;  ///< Velocity of the rotor, ω·h, at the end of the step
  P scaled_torque_end;
  P last_terms;  ///< Sum of the absolute values of the two highest orders of elongation and velocity;
                 ///< estimates the truncation error
};

/// Coefficients of the equations of motion while the contact sticks. Times are divided by h, the length of
/// the step (s); lengths are divided by −s times the softening length (rad), with s the sign of the branch.
template <class P>
struct StickLaw {
  P damping;    ///< Damping of the rotor per step, c·h/J
  P applied;    ///< Constant torque on the rotor, u·h²/J
  P stiffness;  ///< Lowest tangent stiffness of the spring, k1·h²/J
  P softening;  ///< Softening torque of the hysteresis branch with its sign, s·(softening torque)·h²/J
  P creep_limit;  ///< Growth of creep ±α·h/λ per |σ|ⁿ, or per square of scaled_torque if n = 2; 0 while creep
                  ///< is off
  P creep_recovery;  ///< Recovery rate of creep, α·h; 0 while creep is off
  P creep_exponent;  ///< Exponent n of the torque in the creep law
};

/// State of the sticking contact at the start of a step, in the scaled units of StickSeries.
template <class P>
struct StickStart {
  using Mask = typename P::Mask;
  P scaled_creep;    ///< Creep, xh·sgn(σ)
  P velocity;        ///< Velocity of the rotor, ω·h
  P scaled_torque;   ///< Spring torque, σ·h²/J
  P softness;        ///< Exponential exp(−y) of the hysteresis branch's softening
  P torque_power;    ///< Power |σ|ⁿ of the spring torque in the creep law
  Mask at_reversal;  ///< Mask of the lanes in which the elongation rate dxs/dt is zero
  Mask creeping;     ///< Mask of the lanes whose contact creeps in this step
};

/// Mask of the lanes that creep with an exponent n other than 2.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask other_powers(const StickLaw<P>& law, const StickStart<P>& start) {
  return start.creeping & (law.creep_exponent != P(2.0));
}

/// Computes the power series of the motion of sticking contacts over a step, two orders at a time, because
/// their products share most factors. The loop is limited by memory accesses, so it stores only what cannot
/// be derived, and it is not unrolled, because the code would not fit the instruction cache.
/// @tparam AnyPower whether some lane creeps with an exponent other than 2.
/// @param applied ConstantTorque, or a ForcedTorque in the units of the series.
template <bool AnyPower, class P, class Applied>
ZEROCOUNT_ALWAYS_INLINE void expand_orders(const StickLaw<P>& law, const StickStart<P>& start,
                                           [[maybe_unused]] Applied& applied, StickSeries<P>& s) {
  static_assert(batch_order % 2 == 0);
  P softened[batch_order + 1];  // softening·exp(exponent)
  P power[batch_order + 1];     // |σ|ⁿ, where n is not 2
  const P zero(0.0);
  s.scaled_creep[0] = start.scaled_creep;
  s.scaled_torque[0] = start.scaled_torque;
  softened[0] = law.softening * start.softness;
  P elongation = zero;
  P velocity = start.velocity;
  P creep_travel = start.scaled_creep;
  P elongation_change = zero;
  P creep_change = zero;
  P velocity_end = velocity;
  P scaled_torque_end = start.scaled_torque;
  P last_terms = zero;

  P per_start = zero;
  typename P::Mask others = zero < zero;
  if constexpr (AnyPower) {
    per_start = P(1.0) / start.scaled_torque;
    others = other_powers(law, start);
  }
  // |σ|ⁿ of order k, the square of scaled_torque where n = 2.
  const auto power_of = [&](int k, const P& square) __attribute__((always_inline)) {
    if constexpr (AnyPower) {
      power[k] = k == 0 ? start.torque_power
                        : torque_power_coefficient(s.scaled_torque, power, law.creep_exponent, per_start, k);
      return select(others, power[k], square);
    } else {
      return square;
    }
  };
  const auto next_order = [&](int k, const P& square, const P& excess) __attribute__((always_inline)) {
    const P per_order(numerics::reciprocal.of[k + 1]);
    const P creep = law.creep_limit * power_of(k, square) - law.creep_recovery * creep_travel;
    const P rate = k == 0 ? select(start.at_reversal, zero, velocity - creep) : velocity - creep;
    s.rate[k] = rate;
    elongation = rate * per_order;
    creep_travel = creep * per_order;
    velocity = (excess - law.damping * velocity) * per_order;
    s.scaled_creep[k + 1] = creep_travel;
    elongation_change = elongation_change + elongation;
    creep_change = creep_change + creep_travel;
    velocity_end = velocity_end + velocity;
  };
  // `product` is Σ rate[j]·softened[k−1−j].
  const auto next_scaled_torque = [&](int k, const P& product) __attribute__((always_inline)) {
    softened[k] = product * P(numerics::reciprocal.of[k]);
    const P torque = law.stiffness * elongation - softened[k];
    s.scaled_torque[k] = torque;
    scaled_torque_end = scaled_torque_end + torque;
    return torque;
  };
  // Coefficient k ≥ 1 of u − σ, given that of σ.
  const auto unbalanced = [&]([[maybe_unused]] int k, const P& of_spring) __attribute__((always_inline)) {
    if constexpr (Applied::forced) {
      if (applied.forcing.any()) return applied.coefficient(k, velocity) - of_spring;
    }
    return -of_spring;
  };
  if constexpr (Applied::forced) applied.coefficient(0, velocity);
  next_order(0, start.scaled_torque * start.scaled_torque, law.applied - start.scaled_torque);
#pragma GCC unroll 1
  for (int k = 1; k < batch_order; k += 2) {
    // product is Σ rate[j]·softened[k−1−j], j = 0 … k−1; next_product is Σ rate[j]·softened[k−j], j = 1 …
    // k−1.
    P above = softened[k - 1];
    P product = s.rate[0] * above;
    P next_product = zero;
#pragma GCC unroll 1
    for (int j = 1; j < k; ++j) {
      const P below = softened[k - 1 - j];
      const P factor = s.rate[j];
      product = product + factor * below;
      next_product = next_product + factor * above;
      above = below;
    }
    const P torque = next_scaled_torque(k, product);
    // half is Σ σ[j]·σ[k−j], j = 0 … (k−1)/2, for the odd order k; next_half is the known part for k + 1.
    P later = torque;
    P half = s.scaled_torque[0] * later;
    P next_half = zero;
#pragma GCC unroll 1
    for (int j = 1; 2 * j < k; ++j) {
      const P earlier = s.scaled_torque[k - j];
      const P factor = s.scaled_torque[j];
      half = half + factor * earlier;
      next_half = next_half + factor * later;
      later = earlier;
    }
    last_terms = abs(elongation) + abs(velocity);
    next_order(k, half + half, unbalanced(k, torque));
    last_terms = last_terms + (abs(elongation) + abs(velocity));
    const P next =
        next_scaled_torque(k + 1, (next_product + s.rate[0] * softened[k]) + s.rate[k] * softened[0]);
    if (k + 1 == batch_order) break;
    const P middle = s.scaled_torque[(k + 1) / 2];
    next_half = next_half + s.scaled_torque[0] * next;
    next_order(k + 1, (next_half + next_half) + middle * middle, unbalanced(k + 1, next));
  }
  s.rate[batch_order] = velocity;
  s.elongation_change = elongation_change;
  s.creep_change = creep_change;
  s.velocity_end = velocity_end;
  s.scaled_torque_end = scaled_torque_end;
  s.last_terms = last_terms;
}

/// Calls expand_orders() for vectors in which some lane creeps with an exponent other than 2. Not inlined,
/// because this case is rare and would take registers from the common case.
template <class P, class Applied>
__attribute__((noinline)) void expand_any_power(const StickLaw<P>& law, const StickStart<P>& start,
                                                Applied& applied, StickSeries<P>& s) {
  expand_orders<true>(law, start, applied, s);
}

template <class P, class Applied>
ZEROCOUNT_ALWAYS_INLINE void expand(const StickLaw<P>& law, const StickStart<P>& start, Applied& applied,
                                    StickSeries<P>& s) {
  if (other_powers(law, start).any()) {
    expand_any_power(law, start, applied, s);
  } else {
    expand_orders<false>(law, start, applied, s);
  }
}

}  // namespace zerocount::batch
