#pragma once

#include "core/friction/sliding/stribeck_series.hpp"

/// The motion without friction and that of a slide (Slide), for double and for the vectors of the batch
/// engine.
namespace zerocount::friction {

template <class Number>
struct SlideConstants {
  Number damping;                 ///< cs, N m s/rad
  StribeckCurveOf<Number> curve;  ///< g, its torques times the direction d
};

/// Taylor series of a slide. @tparam Series an array of the coefficients.
template <class Series>
struct SlideSeriesOf : StribeckSeriesOf<Series> {
  Series position;  ///< θ, rad
  Series omega;     ///< ω, rad/s
};

/// A motion with viscous damping alone: computes coefficient k + 1 of the position from k of ω.
/// @param torque coefficient k of u. @returns that of u − damping·ω.
template <class Number, class Series>
ZEROCOUNT_ALWAYS_INLINE Number damped_coefficient(const Number& damping, Series& s, std::size_t k,
                                                  const Number& torque) {
  s.position[k + 1] = s.omega[k] * Number(numerics::reciprocal.of[k + 1]);
  return torque - damping * s.omega[k];
}

/// Computes coefficient k of the curve and k + 1 of the position.
/// @tparam Fast g is Fc to the last bit. @param torque coefficient k of u. @returns that of u − cs·ω −
/// d·g(ω).
template <bool Fast, class Number, class Series>
ZEROCOUNT_ALWAYS_INLINE Number slide_coefficient(const SlideConstants<Number>& of, SlideSeriesOf<Series>& s,
                                                 std::size_t k, const Number& torque) {
  const Number driving = k == 0 ? torque - of.curve.coulomb : torque;
  const Number damped = damped_coefficient(of.damping, s, k, driving);
  if constexpr (Fast) return damped;
  s.expand(of.curve.per_velocity_squared, &s.omega[0], k);
  return damped - of.curve.excess * s.decay[k];
}

}  // namespace zerocount::friction
