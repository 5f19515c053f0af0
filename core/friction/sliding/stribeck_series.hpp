#pragma once

#include <cstddef>

#include "core/numerics/series_recurrences.hpp"

/// The Stribeck curve along a motion: for double, as a series in time, and for the vectors of the batch
/// engine, as a series in the fraction of a step of h seconds, with ω·h in place of ω and 1/(ωs·h)² in place
/// of 1/ωs².
namespace zerocount::friction {

/// A motion is fast while |ω| > 8·ωs, where the curve is Fc to the last bit: exp(−64) = 2e-28. A fast step
/// ends, at the latest, where |ω| falls to 6.5·ωs: exp(−42) = 6e-19.
inline constexpr double fast_by_stribeck_velocity = 8.0;
inline constexpr double slow_by_stribeck_velocity = 6.5;

/// Taylor series of exp(−(ω/ωs)²). @tparam Series an array of the coefficients.
template <class Series>
struct StribeckSeriesOf {
  Series exponent;  ///< −(ω/ωs)², dimensionless
  Series slope;     ///< of the exponent
  Series decay;     ///< exp(−(ω/ωs)²), dimensionless; decay[0] is given

  /// Computes coefficient k from omega[0…k].
  template <class Number>
  ZEROCOUNT_ALWAYS_INLINE void expand(const Number& per_velocity_squared, const Number* omega,
                                      std::size_t k) {
    exponent[k] = -per_velocity_squared * numerics::square_coefficient(omega, k);
    if (k == 0) return;
    slope[k - 1] = Number(numerics::whole.of[k]) * exponent[k];
    decay[k] = numerics::exponential_coefficient(&slope[0], &decay[0], k);
  }
};

}  // namespace zerocount::friction
