#pragma once

#include "core/batch/series.hpp"

/// |σ|ⁿ of the creep law in lanes. Exponents other than 2 cost a call of the C library for each lane of a
/// pack that has one; the others in it keep the bits that they have without.
namespace zerocount::batch {

template <class P>
ZEROCOUNT_ALWAYS_INLINE P torque_power(const P& torque, const P& exponent) {
  const P square = torque * torque;
  const typename P::Truth other = exponent != P(2.0);
  if (!other.any()) return square;
  return select(other, power_of(magnitude(torque), exponent), square);
}

/// Coefficient k ≥ 1 of |σ|ⁿ, σ ≠ 0 at the start, from those of σ up to k and those of |σ|ⁿ before it: with
/// p = |σ|ⁿ, σ·p′ = n·σ′·p (see power_coefficient in core/numerics/power_series.hpp).
template <class P>
ZEROCOUNT_ALWAYS_INLINE P power_coefficient(const P* torque, const P* power, const P& exponent, int k) {
  P sum(0.0);
#pragma GCC unroll 1
  for (int j = 1; j <= k; ++j) {
    const P weight = exponent * P(static_cast<double>(j)) - P(static_cast<double>(k - j));
    sum = sum + weight * torque[j] * power[k - j];
  }
  // For n = 1 without the sum, whose terms cancel.
  const P linear = power[0] * torque[k];
  return select(exponent == P(1.0), linear, sum * P(reciprocals.of[k])) / torque[0];
}

}  // namespace zerocount::batch
