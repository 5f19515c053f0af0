#pragma once

#include <cstddef>

#include "core/numerics/series_recurrences.hpp"

/// Formulas of the motion without dry friction and of a slide (Slide), as templates for double and for the
/// vectors of the batch engine.
namespace zerocount::friction {

// The Stribeck curve and its series along a motion, for double and for the vectors of the batch engine.

/// Stribeck curve: the level of sliding friction as a function of the velocity,
///
///   g(ω) = Fc + (Fs − Fc)·exp(−(ω/ωs)²).
///
/// Number is double, a vector of the batch engine, or a number that carries derivatives and has its own
/// exp().
template <class Number>
struct StribeckCurveOf {
  Number coulomb;               ///< Coulomb torque Fc, N m
  Number excess;                ///< Breakaway torque minus Coulomb torque, Fs − Fc, N m
  Number per_velocity_squared;  ///< 1/ωs², with ωs the Stribeck velocity, s²/rad²
};

/// Velocity, divided by the Stribeck velocity ωs, above which a motion counts as fast. There the Stribeck
/// curve is Fc to the last bit: exp(−64) = 2e-28. A fast step ends, at the latest, where |ω| falls to 6.5·ωs:
/// exp(−42) = 6e-19.
inline constexpr double fast_by_stribeck_velocity = 8.0;
inline constexpr double slow_by_stribeck_velocity = 6.5;

/// The Stribeck curve in the time unit h (s), as a function of ω·h. Series in time are then series in the
/// fraction of a step of length h.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE StribeckCurveOf<Number> in_unit_of_time(const StribeckCurveOf<Number>& curve,
                                                                const Number& h) {
  return {curve.coulomb, curve.excess, curve.per_velocity_squared / (h * h)};
}

/// Taylor series in time of exp(−(ω/ωs)²), the exponential of the Stribeck curve.
/// @tparam Series an array of the coefficients.
template <class Series>
struct StribeckSeriesOf {
  Series exponent;  ///< Exponent −(ω/ωs)² of the Stribeck curve, dimensionless
  Series slope;     ///< Time derivative of the exponent, 1/s
  Series decay;  ///< Exponential exp(−(ω/ωs)²) of the Stribeck curve, dimensionless; decay[0] is given

  /// Computes Taylor coefficient k of all members from omega[0…k], the coefficients of the velocity.
  template <class Number>
  ZEROCOUNT_ALWAYS_INLINE void expand(const Number& per_velocity_squared, const Number* omega,
                                      std::size_t k) {
    exponent[k] = -per_velocity_squared * numerics::square_coefficient(omega, k);
    if (k == 0) return;
    slope[k - 1] = Number(numerics::whole.of[k]) * exponent[k];
    decay[k] = numerics::exponential_coefficient(&slope[0], &decay[0], k);
  }
};

/// Taylor series in time of the Stribeck curve: its exponential exp(−(ω/ωs)²) and the friction level g(ω).
template <class Series>
struct LevelSeriesOf : StribeckSeriesOf<Series> {
  Series level;  ///< Friction level g(ω), N m

  /// Computes Taylor coefficient k of all members from omega[0…k], the coefficients of the velocity.
  template <class Number>
  ZEROCOUNT_ALWAYS_INLINE void expand_level(const StribeckCurveOf<Number>& curve, const Number* omega,
                                            std::size_t k) {
    this->expand(curve.per_velocity_squared, omega, k);
    level[k] = curve.excess * this->decay[k];
    if (k == 0) level[0] = level[0] + curve.coulomb;
  }
};

template <class Number>
struct SlideConstants {
  Number damping;                 ///< Viscous damping cs of the slide, N m s/rad
  StribeckCurveOf<Number> curve;  ///< Stribeck curve g, with its torques multiplied by the direction d of the
                                  /// < slide
};

/// Taylor series in time of the motion of a rotor that slides.
/// @tparam Series an array of the coefficients.
template <class Series>
struct SlideSeriesOf : StribeckSeriesOf<Series> {
  Series position;  ///< Rotor angle θ, rad
  Series omega;     ///< Rotor velocity ω, rad/s
};

/// Computes Taylor coefficients of a motion with viscous damping alone: coefficient k + 1 of the position
/// from coefficient k of ω.
/// @param torque coefficient k of the torque u.
/// @returns coefficient k of the accelerating torque u − damping·ω.
template <class Number, class Series>
ZEROCOUNT_ALWAYS_INLINE Number damped_coefficient(const Number& damping, Series& s, std::size_t k,
                                                  const Number& torque) {
  s.position[k + 1] = s.omega[k] * Number(numerics::reciprocal.of[k + 1]);
  return torque - damping * s.omega[k];
}

/// Computes Taylor coefficients of a slide: coefficient k of the Stribeck curve's exponential, and k + 1 of
/// the position.
/// @tparam Fast whether the friction level g is Fc to the last bit.
/// @param torque coefficient k of the torque u.
/// @returns coefficient k of the accelerating torque u − cs·ω − d·g(ω).
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
