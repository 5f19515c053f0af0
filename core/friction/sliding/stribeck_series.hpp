#pragma once

#include <cstddef>

#include "core/numerics/series_recurrences.hpp"

/// The Stribeck curve and its series along a motion, for double and for the vectors of the batch engine.
namespace zerocount::friction {

/// The level of sliding friction over velocity:
///
///   g(ω) = Fc + (Fs − Fc)·exp(−(ω/ωs)²).
///
/// Number is double, a vector of the batch engine, or a number that carries derivatives and has its own
/// exp().
template <class Number>
struct StribeckCurveOf {
  Number coulomb;               ///< Fc, N m
  Number excess;                ///< Fs − Fc, N m
  Number per_velocity_squared;  ///< 1/ωs², s²/rad²
};

/// A motion is fast while |ω| > 8·ωs, where the curve is Fc to the last bit: exp(−64) = 2e-28. A fast step
/// ends, at the latest, where |ω| falls to 6.5·ωs: exp(−42) = 6e-19.
inline constexpr double fast_by_stribeck_velocity = 8.0;
inline constexpr double slow_by_stribeck_velocity = 6.5;

/// The curve with times in the unit of h (s), so with ω·h in place of ω. Series in time are then series in
/// the fraction of a step of h.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE StribeckCurveOf<Number> in_unit_of_time(const StribeckCurveOf<Number>& curve,
                                                                const Number& h) {
  return {curve.coulomb, curve.excess, curve.per_velocity_squared / (h * h)};
}

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

/// And of g(ω).
template <class Series>
struct LevelSeriesOf : StribeckSeriesOf<Series> {
  Series level;  ///< g(ω), N m

  /// Computes coefficient k from omega[0…k].
  template <class Number>
  ZEROCOUNT_ALWAYS_INLINE void expand_level(const StribeckCurveOf<Number>& curve, const Number* omega,
                                            std::size_t k) {
    this->expand(curve.per_velocity_squared, omega, k);
    level[k] = curve.excess * this->decay[k];
    if (k == 0) level[0] = level[0] + curve.coulomb;
  }
};

}  // namespace zerocount::friction
