#pragma once

#include "core/friction/parameters.hpp"
#include "core/friction/sliding/stribeck_series.hpp"
#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/power_series.hpp"

namespace zerocount::friction {

/// The level of sliding friction over velocity:
///
///   g(ω) = Fc + (Fs − Fc)·exp(−(ω/ωs)²).
///
/// Number is double, or a number that carries derivatives and has its own exp().
template <class Number>
struct StribeckCurveOf {
  Number coulomb;               ///< Fc, N m
  Number excess;                ///< Fs − Fc, N m
  Number per_velocity_squared;  ///< 1/ωs², s²/rad²
};
using StribeckCurve = StribeckCurveOf<double>;

/// Fs = breakaway, Fc = coulomb_ratio·Fs, ωs = stribeck_velocity.
inline StribeckCurve stribeck_curve(const FrictionParameters& contact) {
  const double coulomb = contact.coulomb_ratio * contact.breakaway;
  return {coulomb, contact.breakaway - coulomb,
          1.0 / (contact.stribeck_velocity * contact.stribeck_velocity)};
}

/// g(ω), N m.
template <class Number>
Number level_at(const StribeckCurveOf<Number>& curve, Number omega) {
  using numerics::exp;
  return curve.coulomb + curve.excess * exp(-curve.per_velocity_squared * omega * omega);
}

/// Taylor series in time of exp(−(ω/ωs)²).
struct StribeckSeries : StribeckSeriesOf<numerics::Series> {
  StribeckSeries() : StribeckSeriesOf<numerics::Series>{} {}

  /// Computes coefficient k from ω[0…k]. @returns that of decay.
  double expand(const StribeckCurve& curve, const numerics::Series& omega, std::size_t k) {
    StribeckSeriesOf::expand(curve.per_velocity_squared, omega.data(), k);
    if (k == 0) decay[0] = numerics::exp(exponent[0]);
    return decay[k];
  }
};

}  // namespace zerocount::friction
