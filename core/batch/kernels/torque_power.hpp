#pragma once

#include "core/batch/kernels/series.hpp"

/// |σ|ⁿ of the creep law in lanes. The bits of a lane whose exponent is 2 do not depend on the other lanes.
namespace zerocount::batch {

template <class P>
ZEROCOUNT_ALWAYS_INLINE P torque_power(const P& torque, const P& exponent) {
  const P square = torque * torque;
  const typename P::Mask other = exponent != P(2.0);
  if (!other.any()) return square;
  return select(other, pow(abs(torque), exponent), square);
}

/// Coefficient k ≥ 1 of |σ|ⁿ, σ ≠ 0 at the start, from those of σ up to k and those of |σ|ⁿ before it.
/// @param per_start 1/σ at the start
template <class P>
ZEROCOUNT_ALWAYS_INLINE P torque_power_coefficient(const P* torque, const P* power, const P& exponent,
                                                   const P& per_start, int k) {
  // For n = 1 without the sum, whose terms cancel.
  return select(exponent == P(1.0), power[0] * torque[k] * per_start,
                numerics::power_coefficient(torque, power, exponent, per_start, k));
}

}  // namespace zerocount::batch
