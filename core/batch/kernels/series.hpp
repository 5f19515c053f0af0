#pragma once

#include "core/batch/kernels/batch_state.hpp"
#include "core/batch/kernels/simd.hpp"
#include "core/numerics/series_recurrences.hpp"

/// Power series in the fraction x of a step, from 0 to 1. With h the length of the step, coefficient k is hᵏ
/// times the Taylor coefficient in time.
namespace zerocount::batch {

/// sin x and cos x to about 2e-16 + 2e-16·|x| for |x| < 2⁵⁰: x − n·π/2 by Cody and Waite's reduction, and
/// series about 0.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void sine_and_cosine(const P& x, P& sine, P& cosine) {
  using Mask = typename P::Mask;
  const P n = fast_rint(x * P(0x1.45f306dc9c883p-1));  // 2/π
  // π/2 in three parts, of which the first two have 33 bits.
  const P r =
      ((x - n * P(0x1.921fb54400000p+0)) - n * P(0x1.0b4611a600000p-34)) - n * P(0x1.3198a2e037073p-69);
  const P square = r * r;
  constexpr double of_sine[] = {1.0 / 1307674368000.0, 1.0 / 6227020800.0, 1.0 / 39916800.0, 1.0 / 362880.0,
                                1.0 / 5040.0,          1.0 / 120.0,        1.0 / 6.0};
  constexpr double of_cosine[] = {
      1.0 / 20922789888000.0, 1.0 / 87178291200.0, 1.0 / 479001600.0, 1.0 / 3628800.0,
      1.0 / 40320.0,          1.0 / 720.0,         1.0 / 24.0,        0.5};
  P s(-of_sine[0]);
  for (int i = 1; i < 7; ++i) s = P(i % 2 == 0 ? -of_sine[i] : of_sine[i]) + s * square;
  P c(of_cosine[0]);
  for (int i = 1; i < 8; ++i) c = P(i % 2 == 0 ? of_cosine[i] : -of_cosine[i]) + c * square;
  s = r + r * (square * s);
  c = P(1.0) + square * c;
  const P quarter = n - P(4.0) * floor(n * P(0.25));
  const Mask exchanged = (quarter == P(1.0)) | (quarter == P(3.0));
  const P first = select(exchanged, c, s);
  const P second = select(exchanged, s, c);
  sine = select(quarter > P(1.5), -first, first);
  cosine = select((quarter == P(1.0)) | (quarter == P(2.0)), -second, second);
}

/// Value at x of the polynomial c[0] + c[1]·x + … + c[order]·xᵒʳᵈᵉʳ, summed from the smallest terms.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P value_of(const P* c, int order, const P& x) {
  P value = c[order];
#pragma GCC unroll 1
  for (int k = order - 1; k >= 0; --k) value = value * x + c[k];
  return value;
}

/// Value at x = 1 of the polynomial with the coefficients c[0…order]; bitwise equal to value_of(c, order, 1).
template <class P>
ZEROCOUNT_ALWAYS_INLINE P sum_of(const P* c, int order) {
  P value = c[order];
#pragma GCC unroll 1
  for (int k = order - 1; k >= 0; --k) value = value + c[k];
  return value;
}

/// Upper bound of the absolute second derivative on [0, 1] of the polynomial with the coefficients c: Σ
/// k(k−1)·|c[k]|.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P curvature_bound(const P* c, int order) {
  P sum = abs(c[order]) * P(static_cast<double>(order * (order - 1)));
#pragma GCC unroll 1
  for (int k = order - 1; k >= 2; --k) sum = sum + abs(c[k]) * P(static_cast<double>(k * (k - 1)));
  return sum;
}

/// Whether a polynomial surely keeps its sign on [0, 1], given equal signs of its values `at_start` and
/// `at_end`: it is farther from 0 than its curvature can take it, or monotonic.
/// @param slope at the start.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask keeps_sign(const P& at_start, const P& at_end, const P& slope,
                                                    const P& curvature) {
  return (min(abs(at_start), abs(at_end)) > curvature * P(0.125)) | (abs(slope) > curvature);
}

/// Value and first derivative of a polynomial at one point.
template <class P>
struct ValueAndSlope {
  P value;
  P slope;
};

/// Value and derivative at x of the polynomial with the coefficients c[0…order]. Sums even and odd powers
/// apart, so that four chains of additions run in parallel.
template <class P>
ZEROCOUNT_ALWAYS_INLINE ValueAndSlope<P> value_and_slope(const P* c, int order, const P& x) {
  const P square = x * x;
  const int highest_even = order - order % 2;
  P even = c[highest_even];
  P odd = order % 2 == 0 ? c[order - 1] : c[order];
  P even_slope(0.0);
  P odd_slope(0.0);
  if (order % 2 != 0) {
    odd_slope = odd;
    odd = odd * square + c[order - 2];
  }
#pragma GCC unroll 1
  for (int k = highest_even - 2; k >= 2; k -= 2) {
    even_slope = even_slope * square + even;
    odd_slope = odd_slope * square + odd;
    even = even * square + c[k];
    odd = odd * square + c[k - 1];
  }
  even_slope = even_slope * square + even;
  even = even * square + c[0];
  return {even + x * odd, odd + P(2.0) * x * (even_slope + x * odd_slope)};
}

/// Bracketed Newton iteration for a root in each lane of a vector. A lane that has converged keeps its value,
/// so that the result does not depend on the other lanes.
template <class P>
struct NewtonSearch {
  using Mask = typename P::Mask;
  P low;
  P high;
  P x;
  P last_change;
  Mask open;  ///< Mask of the lanes whose iteration has not converged

  /// One iteration: goes to the Newton iterate `newton`, or bisects where that leaves the bracket or
  /// converges slowly.
  /// @param before whether the root is above the present x.
  /// @param close change of x whose square is below rounding; a smaller change ends the iteration of a lane.
  ZEROCOUNT_ALWAYS_INLINE void step(const P& newton, const Mask& before, const P& close) {
    low = select(before, x, low);
    high = select(before, high, x);
    const Mask good = (newton >= low) & (newton <= high) & (abs(newton - x) <= P(0.5) * last_change);
    const P next = select(good, newton, (low + high) * P(0.5));
    last_change = abs(next - x);
    x = select(open, next, x);
    // The error of a Newton step is about the square of the step.
    open = open & (last_change > select(good, close, P(1e-9) * close));
  }
};

constexpr int max_newton_steps = 60;

/// The root between 0 and `end` of the polynomial with the coefficients c[0…order], which has opposite signs
/// at both ends. Starts from the root of the secant. Computed for the lanes of `wanted`.
/// @param at_start, at_end values of the polynomial at 0 and at `end`.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P root_between(const P* c, int order, const P& at_start, const P& at_end,
                                       const P& end, const typename P::Mask& wanted) {
  NewtonSearch<P> search{P(0.0), end, end * (at_start / (at_start - at_end)), end, wanted};
  for (int step = 0; step < max_newton_steps && search.open.any(); ++step) {
    const ValueAndSlope<P> at = value_and_slope(c, order, search.x);
    search.step(search.x - at.value / at.slope, (at.value > P(0.0)) == (at_start > P(0.0)), P(1e-8) * end);
  }
  return search.x;
}

/// Start value of next_zero: the zero of the polynomial of degree 4 that has the same first terms and the
/// same value at 1.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P rough_zero(const P* c, const P& at_end, const typename P::Mask& from_zero) {
  const P c0 = select(from_zero, c[1], c[0]);
  const P c1 = select(from_zero, c[2], c[1]);
  const P c2 = select(from_zero, c[3], c[2]);
  const P c3 = select(from_zero, c[4], c[3]);
  const P c4 = at_end - (((c0 + c1) + c2) + c3);
  const P secant = c0 / (c0 - at_end);
  P x = secant;
  for (int step = 0; step < 2; ++step) {
    const P cubic = c4 * x + c3;
    const P square = cubic * x + c2;
    const P linear = square * x + c1;
    const P value = linear * x + c0;
    const P slope = ((c4 * x + cubic) * x + square) * x + linear;
    x = x - value / slope;
  }
  return select((x > P(0.0)) & (x < P(1.0)), x, secant);
}

/// The zero of the polynomial with the coefficients c[0…order] on (0, 1). In the lanes of `from_zero` the
/// polynomial is zero at 0, and the zero of the polynomial divided by x is found. An error of its position
/// enters the motion squared, because the velocity at a reversal is zero.
/// @param at_start the value at 0, or the slope in the lanes of `from_zero`.
/// @param at_end the value at 1.
/// @param wanted lanes to compute.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P next_zero(const P* c, int order, const P& at_start, const P& at_end,
                                    const typename P::Mask& from_zero, const typename P::Mask& wanted) {
  NewtonSearch<P> search{P(0.0), P(1.0), rough_zero(c, at_end, from_zero), P(1.0), wanted};
  for (int step = 0; step < max_newton_steps && search.open.any(); ++step) {
    const P x = search.x;
    const ValueAndSlope<P> at = value_and_slope(c, order, x);
    const P by_x = x * at.slope;
    const P newton = x - x * at.value / select(from_zero, by_x - at.value, by_x);
    search.step(newton, (at.value > P(0.0)) == (at_start > P(0.0)), P(1e-5));
  }
  return search.x;
}

// |σ|ⁿ of the creep law in lanes. The bits of a lane whose exponent is 2 do not depend on the other lanes.

template <class P>
ZEROCOUNT_ALWAYS_INLINE P torque_power(const P& torque, const P& exponent) {
  const P square = torque * torque;
  const typename P::Mask other = exponent != P(2.0);
  if (!other.any()) return square;
  return select(other, pow(abs(torque), exponent), square);
}

/// Coefficient k ≥ 1 of the series of |σ|ⁿ, given the coefficients of σ up to k and the coefficients of |σ|ⁿ
/// up to k − 1. σ must not be 0 at the start.
/// @param torque, power coefficients of σ and of |σ|ⁿ.
/// @param exponent n.
/// @param per_start 1/σ at the start.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P torque_power_coefficient(const P* torque, const P* power, const P& exponent,
                                                   const P& per_start, int k) {
  // For n = 1 without the sum, whose terms cancel.
  return select(exponent == P(1.0), power[0] * torque[k] * per_start,
                numerics::power_coefficient(torque, power, exponent, per_start, k));
}

}  // namespace zerocount::batch
