#pragma once

#include "core/batch/torque_power.hpp"

namespace zerocount::batch {

/// The series of a step. Lengths are by the softening length, as the exponent of the branch has them: from
/// elongation to exponent by −s·(softening rate), which has either sign.
template <class P>
struct StickSeries {
  P rate[batch_order + 1];    ///< dxs/dt·h; its highest order is without creep
  P growth[batch_order + 1];  ///< xh·sgn(σ)
  P pull[batch_order + 1];    ///< σ·h²/J

  // Over the whole step.
  P elongation_change;
  P growth_change;
  P velocity_end;  ///< ω·h
  P pull_end;
  P last_terms;  ///< the two highest orders of elongation and velocity: their sizes
};

/// The law of a step in units of h and the softening length.
template <class P>
struct StickLaw {
  P damping;         ///< c·h/J
  P applied;         ///< u·h²/J
  P stiffness;       ///< k1·h²/J
  P softening;       ///< s·softening torque·h²/J
  P creep_limit;     ///< ±α·h/λ by σⁿ; where n = 2, by the square of the pull; 0 where creep is off
  P creep_recovery;  ///< α·h, 0 where creep is off
  P creep_exponent;  ///< n
};

/// The start of a step.
template <class P>
struct StickStart {
  using Mask = typename P::Mask;
  P growth;       ///< xh·sgn(σ)
  P velocity;     ///< ω·h
  P pull;         ///< σ·h²/J
  P softness;     ///< exp(−y) of the branch
  P torque;       ///< σ, N m
  Mask turning;   ///< dxs/dt is zero
  Mask creeping;  ///< of the lanes that take part
};

/// The lanes that creep with an exponent other than 2.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask other_powers(const StickLaw<P>& law, const StickStart<P>& start) {
  return start.creeping & (law.creep_exponent != P(2.0));
}

/// The series, two orders at a time: the products of both share most of their factors. Memory
/// limits this loop, so it stores only what cannot be derived from the rest. Rolled up,
/// because the code of it all would not fit the instruction cache.
/// @tparam AnyPower some lane creeps with an exponent other than 2.
template <bool AnyPower, class P>
ZEROCOUNT_ALWAYS_INLINE void expand_orders(const StickLaw<P>& law, const StickStart<P>& start,
                                           StickSeries<P>& s) {
  static_assert(batch_order % 2 == 0);
  P softened[batch_order + 1];  // softening·exp(exponent)
  P power[batch_order + 1];     // |σ|ⁿ, where n is not 2
  const P zero(0.0);
  s.growth[0] = start.growth;
  s.pull[0] = start.pull;
  softened[0] = law.softening * start.softness;
  P elongation = zero;
  P velocity = start.velocity;
  P growth = start.growth;
  P elongation_change = zero;
  P growth_change = zero;
  P velocity_end = velocity;
  P pull_end = start.pull;
  P last_terms = zero;

  // |σ|ⁿ of order k, the square of the pull where n = 2.
  const auto power_of = [&](int k, const P& square) __attribute__((always_inline)) {
    if constexpr (AnyPower) {
      power[k] = k == 0 ? pow(abs(start.torque), law.creep_exponent)
                        : torque_power_coefficient(s.pull, power, law.creep_exponent, k);
      return select(other_powers(law, start), power[k], square);
    } else {
      return square;
    }
  };
  const auto next_order = [&](int k, const P& square, const P& unbalanced) __attribute__((always_inline)) {
    const P per_order(numerics::reciprocal.of[k + 1]);
    const P creep = law.creep_limit * power_of(k, square) - law.creep_recovery * growth;
    const P rate = k == 0 ? select(start.turning, zero, velocity - creep) : velocity - creep;
    s.rate[k] = rate;
    elongation = rate * per_order;
    growth = creep * per_order;
    velocity = (unbalanced - law.damping * velocity) * per_order;
    s.growth[k + 1] = growth;
    elongation_change = elongation_change + elongation;
    growth_change = growth_change + growth;
    velocity_end = velocity_end + velocity;
  };
  // From Σ rate[j]·softened[k−1−j].
  const auto next_pull = [&](int k, const P& product) __attribute__((always_inline)) {
    softened[k] = product * P(numerics::reciprocal.of[k]);
    const P pull = law.stiffness * elongation - softened[k];
    s.pull[k] = pull;
    pull_end = pull_end + pull;
    return pull;
  };
  next_order(0, start.pull * start.pull, law.applied - start.pull);
#pragma GCC unroll 1
  for (int k = 1; k < batch_order; k += 2) {
    // Of order k: Σ rate[j]·softened[k−1−j], j = 0 … k−1. Of the next: Σ rate[j]·softened[k−j], j = 1 …
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
    const P pull = next_pull(k, product);
    // The square of order k, which is odd: 2·Σ σ[j]·σ[k−j], j = 0 … (k−1)/2; and what of the next is known.
    P later = pull;
    P half = s.pull[0] * later;
    P next_half = zero;
#pragma GCC unroll 1
    for (int j = 1; 2 * j < k; ++j) {
      const P earlier = s.pull[k - j];
      const P factor = s.pull[j];
      half = half + factor * earlier;
      next_half = next_half + factor * later;
      later = earlier;
    }
    last_terms = abs(elongation) + abs(velocity);
    next_order(k, half + half, -pull);
    last_terms = last_terms + (abs(elongation) + abs(velocity));
    const P next = next_pull(k + 1, (next_product + s.rate[0] * softened[k]) + s.rate[k] * softened[0]);
    if (k + 1 == batch_order) break;
    const P middle = s.pull[(k + 1) / 2];
    next_half = next_half + s.pull[0] * next;
    next_order(k + 1, (next_half + next_half) + middle * middle, -next);
  }
  s.rate[batch_order] = velocity;
  s.elongation_change = elongation_change;
  s.growth_change = growth_change;
  s.velocity_end = velocity_end;
  s.pull_end = pull_end;
  s.last_terms = last_terms;
}

/// Not inlined: rare, and its calls of the C library would keep the values of the other in memory.
template <class P>
__attribute__((noinline)) void expand_any_power(const StickLaw<P>& law, const StickStart<P>& start,
                                                StickSeries<P>& s) {
  expand_orders<true>(law, start, s);
}

template <class P>
ZEROCOUNT_ALWAYS_INLINE void expand(const StickLaw<P>& law, const StickStart<P>& start, StickSeries<P>& s) {
  if (other_powers(law, start).any()) {
    expand_any_power(law, start, s);
  } else {
    expand_orders<false>(law, start, s);
  }
}

}  // namespace zerocount::batch
