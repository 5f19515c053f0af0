#pragma once

#include "core/batch/torque_power.hpp"

namespace zerocount::batch {

/// The series of a step, in rad: xs, the hardening with the sign of σ, σ·h²/J, ω·h, and dxs/dt·h.
template <class P>
struct StickSeries {
  P elongation[batch_order + 1];
  P growth[batch_order + 1];
  P pull[batch_order + 1];
  P velocity[batch_order + 1];
  P rate[batch_order + 1];  ///< the highest order without creep
};

/// Coefficient k of dxp/dt·h, below the highest order: that of the growth after it.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P creep_coefficient(const StickSeries<P>& s, int k) {
  return P(static_cast<double>(k + 1)) * s.growth[k + 1];
}

/// The law of a step in units of h, torques by h²/J.
template <class P>
struct StickLaw {
  P damping;         ///< c·h/J
  P applied;         ///< u·h²/J
  P stiffness;       ///< k1·h²/J
  P softening;       ///< s·softening torque·h²/J
  P exponent;        ///< −s·softening rate, 1/rad
  P creep_limit;     ///< ±α·h/λ by σⁿ; where n = 2, by (σ·h²/J)²; 0 where creep is off
  P creep_recovery;  ///< α·h, 0 where creep is off
  P creep_exponent;  ///< n
};

/// The start of a step.
template <class P>
struct StickStart {
  using Mask = typename P::Mask;
  P elongation;   ///< xs, rad
  P growth;       ///< xh·sgn(σ), rad
  P velocity;     ///< ω·h, rad
  P pull;         ///< σ·h²/J, rad
  P softness;     ///< exp(−y) of the branch
  P torque;       ///< σ, N m
  Mask turning;   ///< dxs/dt is zero
  Mask creeping;  ///< of the lanes that take part
};

/// The series, two orders at a time: the products of both share most of their factors, and what limits this
/// loop is how fast they come from memory. Rolled up, because the code of it all would not fit the
/// instruction cache.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void expand(const StickLaw<P>& law, const StickStart<P>& start, StickSeries<P>& s) {
  static_assert(batch_order % 2 == 0);
  P softened[batch_order + 1];  // softening·exp(exponent·(xs − xs₀))·softness
  P slope[batch_order + 1];     // of its exponent
  P power[batch_order + 1];     // |σ|ⁿ, or (σ·h²/J)² where n = 2
  const P zero(0.0);
  const bool creeping = start.creeping.any();
  const typename P::Mask other_powers = start.creeping & (law.creep_exponent != P(2.0));
  const bool any_other_power = other_powers.any();
  s.elongation[0] = start.elongation;
  s.growth[0] = start.growth;
  s.pull[0] = start.pull;
  s.velocity[0] = start.velocity;
  softened[0] = law.softening * start.softness;
  power[0] = start.pull * start.pull;
  if (any_other_power) {
    power[0] = select(other_powers, pow(abs(start.torque), law.creep_exponent), power[0]);
  }
  const auto power_of = [&](const P& square, int k) {
    if (!any_other_power) return square;
    return select(other_powers, torque_power_coefficient(s.pull, power, law.creep_exponent, k), square);
  };
  const auto next_order = [&](int k, const P& unbalanced) {
    const P per_order(numerics::reciprocal.of[k + 1]);
    const P creep = law.creep_limit * power[k] - law.creep_recovery * s.growth[k];
    const P velocity = s.velocity[k];
    const P rate = k == 0 ? select(start.turning, zero, velocity - creep) : velocity - creep;
    s.rate[k] = rate;
    slope[k] = law.exponent * rate;
    s.elongation[k + 1] = rate * per_order;
    s.growth[k + 1] = creep * per_order;
    s.velocity[k + 1] = (unbalanced - law.damping * velocity) * per_order;
  };
  // From Σ slope[j]·softened[k−1−j].
  const auto next_pull = [&](int k, const P& product) {
    softened[k] = product * P(numerics::reciprocal.of[k]);
    s.pull[k] = law.stiffness * s.elongation[k] - softened[k];
  };
  next_order(0, law.applied - start.pull);
#pragma GCC unroll 1
  for (int k = 1; k < batch_order; k += 2) {
    // Of order k: Σ slope[j]·softened[k−1−j], j = 0 … k−1. Of the next: Σ slope[j]·softened[k−j], j = 1 …
    // k−1.
    P above = softened[k - 1];
    P product = slope[0] * above;
    P next_product = zero;
#pragma GCC unroll 1
    for (int j = 1; j < k; ++j) {
      const P below = softened[k - 1 - j];
      const P factor = slope[j];
      product = product + factor * below;
      next_product = next_product + factor * above;
      above = below;
    }
    next_pull(k, product);
    // The square of order k, which is odd: 2·Σ σ[j]·σ[k−j], j = 0 … (k−1)/2; and what of the next is known.
    P half = zero;
    P next_half = zero;
    if (creeping) {
      P later = s.pull[k];
      half = s.pull[0] * later;
#pragma GCC unroll 1
      for (int j = 1; 2 * j < k; ++j) {
        const P earlier = s.pull[k - j];
        const P factor = s.pull[j];
        half = half + factor * earlier;
        next_half = next_half + factor * later;
        later = earlier;
      }
    }
    power[k] = power_of(half + half, k);
    next_order(k, -s.pull[k]);
    next_pull(k + 1, (next_product + slope[0] * softened[k]) + slope[k] * softened[0]);
    if (k + 1 == batch_order) break;
    P square = zero;
    if (creeping) {
      const P middle = s.pull[(k + 1) / 2];
      next_half = next_half + s.pull[0] * s.pull[k + 1];
      square = (next_half + next_half) + middle * middle;
    }
    power[k + 1] = power_of(square, k + 1);
    next_order(k + 1, -s.pull[k + 1]);
  }
  s.rate[batch_order] = s.velocity[batch_order];
}

}  // namespace zerocount::batch
