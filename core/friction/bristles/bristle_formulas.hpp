#pragma once

#include <cstddef>

#include "core/friction/sliding/slide_formulas.hpp"

/// Formulas of a friction law with an elastic bristle, as templates for double and for the vectors of the
/// batch engine.
namespace zerocount::friction {

template <class Number>
struct BristleConstants {
  Number stiffness;               ///< Stiffness σ0 of the bristle, N m/rad
  Number bristle_damping;         ///< Damping σ1 of the bristle, N m s/rad
  Number damping;                 ///< Viscous damping d of the rotor, N m s/rad
  StribeckCurveOf<Number> level;  ///< Friction level g(ω), a Stribeck curve
};

/// The constants converted to the time unit h (s), so that time derivatives are per h.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE BristleConstants<Number> in_unit_of_time(const BristleConstants<Number>& of,
                                                                 const Number& h) {
  return {of.stiffness, of.bristle_damping / h, of.damping / h, in_unit_of_time(of.level, h)};
}

/// Taylor series in time of the motion of a bristle and its rotor.
/// @tparam Series an array of the coefficients.
template <class Series>
struct BristleSeriesOf : LevelSeriesOf<Series> {
  Series position;    ///< Rotor angle θ, rad
  Series omega;       ///< Rotor velocity ω, rad/s
  Series deflection;  ///< Deflection z of the bristle, rad
  Series ratio;       ///< Ratio ω·z/g(ω) of the bristle's equation, rad²/(N m s)
};

/// Computes the Taylor coefficients k of the friction level and of the ratio ω·z/g(ω), and k + 1 of θ and z
/// (BristleMotion).
/// @tparam ConstantLevel whether the friction level g is Fc.
/// @param direction sign s of ω.
/// @param saturated whether z stays as it is; only with a constant level.
/// @param torque coefficient k of the torque u on the rotor.
/// @returns coefficient k of the accelerating torque u − σ0·z − σ1·dz/dt − d·ω.
template <bool ConstantLevel, class Number, class Mask, class Series>
ZEROCOUNT_ALWAYS_INLINE Number bristle_coefficient(const BristleConstants<Number>& of,
                                                   const Number& direction,
                                                   [[maybe_unused]] const Mask& saturated,
                                                   BristleSeriesOf<Series>& s, std::size_t k,
                                                   const Number& torque) {
  const Number per_order(numerics::reciprocal.of[k + 1]);
  const Number product = numerics::product_coefficient(&s.omega[0], &s.deflection[0], k);
  if constexpr (ConstantLevel) {
    s.ratio[k] = by_fixed(product, of.level.coulomb);
  } else {
    s.expand_level(of.level, &s.omega[0], k);
    s.ratio[k] = numerics::quotient_coefficient(product, &s.level[0], &s.ratio[0], k);
  }
  Number rate = s.omega[k] - direction * of.stiffness * s.ratio[k];
  if constexpr (ConstantLevel) rate = select(saturated, Number(0.0), rate);
  s.position[k + 1] = s.omega[k] * per_order;
  s.deflection[k + 1] = rate * per_order;
  return torque - of.stiffness * s.deflection[k] - of.bristle_damping * rate - of.damping * s.omega[k];
}

/// Whether the contact counts as sliding: its friction without the viscous damping d is above 0.99·g(ω).
/// @param deflection z, rad.
/// @param omega ω, rad/s.
/// @param level g(ω), N m.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE auto bristle_slides(const BristleConstants<Number>& of, const Number& deflection,
                                            const Number& omega, const Number& level) {
  const Number rate = omega - of.stiffness * abs(omega) * deflection / level;
  return abs(of.stiffness * deflection + of.bristle_damping * rate) > Number(0.99) * level;
}

/// Whether the bristle of a fast rotor may be set to its deflection in steady sliding, `end`. The distance |z
/// − end|, which decays as exp(−σ0·∫|ω|dt/Fc), changes ω by Fc·|z − end|/(J·|ω|); the function is true if
/// this is at most 1e-12 of ω.
/// @param deflection z, rad.
/// @param end sgn(ω)·Fc/σ0, rad.
/// @param coulomb Fc, N m.
/// @param inertia J, kg m².
/// @param omega ω, rad/s.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE auto is_at_end(const Number& deflection, const Number& end, const Number& coulomb,
                                       const Number& inertia, const Number& omega) {
  const Number rest = abs(deflection - end);
  return (coulomb * rest <= Number(1e-12) * inertia * omega * omega) & (rest <= Number(1e-6) * abs(end));
}

/// Whether a bristle in balance with `torque` comes to rest: a bound of all further travel,
///
///   4·(|z − u/σ0| + |ω|/ωn + J·|ω|/b)·(1 + J·ωn/b)/m,   m = 1 − |u|/g(0), b = σ1·m + d, ωn² = σ0/J,
///
/// is below `rest` (rad). In the direction of u the bristle yields with the stiffness σ0·m and the damping b;
/// half a period of a small oscillation about z = u/σ0 reduces it by exp(−π·b/(2·√2·J·ωn)) or more.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE auto bristle_rests(const BristleConstants<Number>& of, const Number& deflection,
                                           const Number& omega, const Number& torque, const Number& inertia,
                                           const Number& rest) {
  const Number one(1.0);
  const Number margin = one - abs(torque) / (of.level.coulomb + of.level.excess);
  const Number resistance = of.bristle_damping * margin + of.damping;
  const Number frequency = sqrt(of.stiffness / inertia);
  const Number excursion =
      abs(deflection - torque / of.stiffness) + abs(omega) * (one / frequency + inertia / resistance);
  return (margin > Number(0.0)) & (resistance > Number(0.0)) &
         (Number(4.0) * excursion * (one + inertia * frequency / resistance) < rest * margin);
}

}  // namespace zerocount::friction
