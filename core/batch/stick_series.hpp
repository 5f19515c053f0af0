#pragma once

#include "core/batch/torque_power.hpp"

namespace zerocount::batch {

/// The series of a step: xs, ω·h, the hardening with the sign of σ, σ, and the rates of xs and xp times h.
template <class P>
struct StickSeries {
  P elongation[batch_order + 1];
  P velocity[batch_order + 1];
  P growth[batch_order + 1];
  P torque[batch_order + 1];
  P rate[batch_order + 1];
  P creep[batch_order + 1];
};

/// The law of a step in units of h.
template <class P>
struct StickLaw {
  P acceleration;    ///< h²/J
  P damping;         ///< c·h/J
  P applied;         ///< u
  P k1;              ///< N m/rad
  P softening;       ///< s·softening torque
  P exponent;        ///< −s·softening rate
  P creep_limit;     ///< ±α·h/λ, 0 where creep is off
  P creep_recovery;  ///< α·h, 0 where creep is off
  P creep_exponent;  ///< n
};

/// Completes order k of the series, given the exponential and |σ|ⁿ at that order.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void next_order(const StickLaw<P>& law, int k, const P& power, const P& start_rate,
                                        StickSeries<P>& s, P* slope) {
  s.creep[k] = law.creep_limit * power - law.creep_recovery * s.growth[k];
  if (k == batch_order) return;
  s.rate[k] = k == 0 ? start_rate : s.velocity[k] - s.creep[k];
  slope[k] = law.exponent * s.rate[k];
  const P unbalanced = k == 0 ? law.applied - s.torque[0] : -s.torque[k];
  const P per_order(numerics::reciprocal.of[k + 1]);
  s.elongation[k + 1] = s.rate[k] * per_order;
  s.growth[k + 1] = s.creep[k] * per_order;
  s.velocity[k + 1] = (law.acceleration * unbalanced - law.damping * s.velocity[k]) * per_order;
}

/// σ of order k ≥ 1, from the coefficient of (exponent)′·exp(exponent) before it.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void next_torque(const StickLaw<P>& law, int k, const P& product, StickSeries<P>& s,
                                         P* softness) {
  softness[k] = product * P(numerics::reciprocal.of[k]);
  s.torque[k] = law.k1 * s.elongation[k] - law.softening * softness[k];
}

/// The series, two orders at a time: the products of both share most of their factors, and what limits this
/// loop is how fast they come from memory. Rolled up, because the code of it all would not fit the
/// instruction cache.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void expand(const StickLaw<P>& law, const P& softness_at_start,
                                    const typename P::Mask& turning, const typename P::Mask& creeping_lanes,
                                    StickSeries<P>& s) {
  static_assert(batch_order % 2 == 0);
  P softness[batch_order + 1];
  P slope[batch_order + 1];
  P power[batch_order + 1];  // |σ|ⁿ
  softness[0] = softness_at_start;
  const P zero(0.0);
  const bool creeping = creeping_lanes.any();
  const typename P::Mask other_powers = creeping_lanes & (law.creep_exponent != P(2.0));
  const bool any_other_power = other_powers.any();
  power[0] = s.torque[0] * s.torque[0];
  if (any_other_power) {
    power[0] = select(other_powers, pow(abs(s.torque[0]), law.creep_exponent), power[0]);
  }
  const P creep_start = creeping ? law.creep_limit * power[0] - law.creep_recovery * s.growth[0] : zero;
  const P start_rate = select(turning, zero, s.velocity[0] - creep_start);
  next_order(law, 0, power[0], start_rate, s, slope);
#pragma GCC unroll 1
  for (int k = 1; k < batch_order; k += 2) {
    // Of order k: Σ slope[j]·softness[k−1−j], j = 0 … k−1. Of the next: Σ slope[j]·softness[k−j], j = 1 …
    // k−1.
    P above = softness[k - 1];
    P product = slope[0] * above;
    P next_product = zero;
#pragma GCC unroll 1
    for (int j = 1; j < k; ++j) {
      const P below = softness[k - 1 - j];
      const P factor = slope[j];
      product = product + factor * below;
      next_product = next_product + factor * above;
      above = below;
    }
    next_torque(law, k, product, s, softness);
    // σ² of order k, which is odd: 2·Σ σ[j]·σ[k−j], j = 0 … (k−1)/2; and what of the next is known.
    P half = zero;
    P next_half = zero;
    if (creeping) {
      P later = s.torque[k];
      half = s.torque[0] * later;
#pragma GCC unroll 1
      for (int j = 1; 2 * j < k; ++j) {
        const P earlier = s.torque[k - j];
        const P factor = s.torque[j];
        half = half + factor * earlier;
        next_half = next_half + factor * later;
        later = earlier;
      }
    }
    power[k] = half + half;
    if (any_other_power) {
      power[k] =
          select(other_powers, torque_power_coefficient(s.torque, power, law.creep_exponent, k), power[k]);
    }
    next_order(law, k, power[k], zero, s, slope);
    next_product = (next_product + slope[0] * softness[k]) + slope[k] * softness[0];
    next_torque(law, k + 1, next_product, s, softness);
    power[k + 1] = zero;
    if (creeping) {
      const P middle = s.torque[(k + 1) / 2];
      next_half = next_half + s.torque[0] * s.torque[k + 1];
      power[k + 1] = (next_half + next_half) + middle * middle;
    }
    if (any_other_power) {
      power[k + 1] = select(
          other_powers, torque_power_coefficient(s.torque, power, law.creep_exponent, k + 1), power[k + 1]);
    }
    next_order(law, k + 1, power[k + 1], zero, s, slope);
  }
}

}  // namespace zerocount::batch
