#pragma once

#include <cstddef>

#include "core/numerics/series_recurrences.hpp"

/// Formulas of the Taylor series of disturbances, as templates for double and for the vectors of the batch
/// engine.
namespace zerocount::motion {

/// Taylor series of s = sin(q·θ + φ) and its cosine c along a motion,
///
///   ds/dt = q·ω·c,   dc/dt = −q·ω·s.
///
/// The coefficients of order 0 are given.
/// @tparam Series an array of the coefficients.
template <class Series>
struct WaveSeriesOf {
  Series sine;
  Series cosine;

  /// Computes the coefficients k ≥ 1 of sine and cosine, given the coefficients of the velocity ω up to k −
  /// 1.
  /// @param per_angle q.
  template <class Number>
  ZEROCOUNT_ALWAYS_INLINE void expand(const Number& per_angle, const Number* omega, std::size_t k) {
    Number of_sine(0.0);
    Number of_cosine(0.0);
#pragma GCC unroll 1
    for (std::size_t j = 0; j < k; ++j) {
      of_sine = of_sine + omega[j] * cosine[k - 1 - j];
      of_cosine = of_cosine - omega[j] * sine[k - 1 - j];
    }
    sine[k] = per_angle * of_sine * Number(numerics::reciprocal.of[k]);
    cosine[k] = per_angle * of_cosine * Number(numerics::reciprocal.of[k]);
  }
};

/// Adds the Taylor coefficients of the vibration A·sin(rate·t + φ) about t = 0 to a series that ends with the
/// power `order`.
/// @param sine, cosine A·sin φ and A·cos φ.
template <class Number, class Series>
ZEROCOUNT_ALWAYS_INLINE void add_line(const Number& rate, Number sine, Number cosine, std::size_t order,
                                      Series& series) {
  series[0] = series[0] + sine;
#pragma GCC unroll 1
  for (std::size_t k = 1; k <= order; ++k) {
    const Number step = rate * Number(numerics::reciprocal.of[k]);
    const Number next = step * cosine;  // the derivatives of sin are cos, −sin, …
    cosine = -step * sine;
    sine = next;
    series[k] = series[k] + sine;
  }
}

}  // namespace zerocount::motion
