#pragma once

#include "core/friction/parameters.hpp"
#include "core/friction/sliding/stribeck_series.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::friction {

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

/// exp(−(ω/ωs)²), the coefficient 0 of StribeckSeriesOf::decay.
inline double decay_at(const StribeckCurve& curve, double omega) {
  return numerics::exp(-curve.per_velocity_squared * (omega * omega));
}

}  // namespace zerocount::friction
