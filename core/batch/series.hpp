#pragma once

#include "core/batch/batch_state.hpp"
#include "core/batch/lanes.hpp"
#include "core/numerics/series_recurrences.hpp"

/// Power series in the fraction of a step, from 0 to 1: coefficient k is that in time, times hᵏ.
namespace zerocount::batch {

/// The polynomial at x, smallest terms first.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P value_of(const P* c, int order, const P& x) {
  P value = c[order];
#pragma GCC unroll 1
  for (int k = order - 1; k >= 0; --k) value = value * x + c[k];
  return value;
}

/// Four polynomials at x, of which each goes as value_of has it.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void values_of(const P* a, const P* b, const P* c, const P* d, int order, const P& x,
                                       P (&value)[4]) {
  value[0] = a[order];
  value[1] = b[order];
  value[2] = c[order];
  value[3] = d[order];
#pragma GCC unroll 1
  for (int k = order - 1; k >= 0; --k) {
    value[0] = value[0] * x + a[k];
    value[1] = value[1] * x + b[k];
    value[2] = value[2] * x + c[k];
    value[3] = value[3] * x + d[k];
  }
}

/// The polynomial at x = 1; bitwise equal to value_of(c, order, 1).
template <class P>
ZEROCOUNT_ALWAYS_INLINE P sum_of(const P* c, int order) {
  P value = c[order];
#pragma GCC unroll 1
  for (int k = order - 1; k >= 0; --k) value = value + c[k];
  return value;
}

/// Σ k(k−1)·|c[k]|, which no second derivative on [0, 1] exceeds.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P curvature_bound(const P* c, int order) {
  P sum = abs(c[order]) * P(static_cast<double>(order * (order - 1)));
#pragma GCC unroll 1
  for (int k = order - 1; k >= 2; --k) sum = sum + abs(c[k]) * P(static_cast<double>(k * (k - 1)));
  return sum;
}

/// Σ |c[k]|, k ≥ 1, which the polynomial does not move farther on [0, 1].
template <class P>
ZEROCOUNT_ALWAYS_INLINE P reach_bound(const P* c, int order) {
  P sum = abs(c[order]);
#pragma GCC unroll 1
  for (int k = order - 1; k >= 1; --k) sum = sum + abs(c[k]);
  return sum;
}

/// Whether a polynomial, of values `at_start` and `at_end` and slope `slope` at the start, surely keeps its
/// sign on [0, 1] where the two values have the same: it is farther from 0 than it can bend, or it is
/// monotonic.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask cannot_turn(const P& at_start, const P& at_end, const P& slope,
                                                     const P& curvature) {
  return (min(abs(at_start), abs(at_end)) > curvature * P(0.125)) | (abs(slope) > curvature);
}

/// The root of a polynomial between 0 and `end`, where it has the sign other than `at_start`'s: from the
/// secant's by Newton's iteration, and by bisection where that leaves the bracket or shrinks slowly. Each
/// lane stays as soon as it has arrived, so that it does not matter how long others take. Only the lanes of
/// `wanted` count.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P root_between(const P* c, int order, const P& at_start, const P& at_end,
                                       const P& end, const typename P::Mask& wanted) {
  constexpr int max_steps = 60;
  P low(0.0);
  P high = end;
  P x = end * (at_start / (at_start - at_end));
  P last_change = end;
  typename P::Mask open = wanted;
  for (int step = 0; step < max_steps; ++step) {
    // The even and the odd powers apart, and their derivatives: four chains of additions in place of two.
    const P square = x * x;
    P even(0.0);
    P odd(0.0);
    P even_slope(0.0);
    P odd_slope(0.0);
#pragma GCC unroll 1
    for (int k = order; k >= 1; k -= 2) {
      const int even_power = order % 2 == 0 ? k : k - 1;
      const int odd_power = order % 2 == 0 ? k - 1 : k;
      even_slope = even_slope * square + even;
      odd_slope = odd_slope * square + odd;
      even = even * square + c[even_power];
      odd = odd * square + c[odd_power];
    }
    if (order % 2 == 0) {
      even_slope = even_slope * square + even;
      even = even * square + c[0];
    }
    const P value = even + x * odd;
    const P slope = odd + P(2.0) * x * (even_slope + x * odd_slope);
    const typename P::Mask before = (value > P(0.0)) == (at_start > P(0.0));
    low = select(before, x, low);
    high = select(before, high, x);
    const P newton = x - value / slope;
    const typename P::Mask good =
        (newton >= low) & (newton <= high) & (abs(newton - x) <= P(0.5) * last_change);
    const P next = select(good, newton, (low + high) * P(0.5));
    last_change = abs(next - x);
    x = select(open, next, x);
    open = open & (last_change > P(1e-8) * end);  // squared by the step that has just been made
    if (!open.any()) break;
  }
  return x;
}

}  // namespace zerocount::batch
