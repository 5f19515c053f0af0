#pragma once

#include <cstddef>

#include "core/numerics/series_recurrences.hpp"

/// Formulas of a bristle for double and for the vectors of the batch engine.
namespace zerocount::friction {

/// Coefficient k of dz/dt = ω − s·σ0·ω·z/g(ω), and of `ratio`, ω·z/g(ω), from those of ω, z and g up to k.
/// @param stiffness s·σ0
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number bristle_rate_coefficient(const Number& stiffness, const Number* omega,
                                                        const Number* deflection, const Number* level,
                                                        Number* ratio, std::size_t k) {
  ratio[k] =
      numerics::quotient_coefficient(numerics::product_coefficient(omega, deflection, k), level, ratio, k);
  return omega[k] - stiffness * ratio[k];
}

/// Whether friction without the damping d is above 0.99·g(ω): the bristle counts as sliding.
/// @param stiffness σ0. @param bristle_damping σ1. @param level g(ω), N m.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE auto bristle_slides(const Number& deflection, const Number& omega,
                                            const Number& stiffness, const Number& bristle_damping,
                                            const Number& level) {
  const Number rate = omega - stiffness * abs(omega) * deflection / level;
  return abs(stiffness * deflection + bristle_damping * rate) > Number(0.99) * level;
}

/// Whether the bristle of a fast rotor may be set to its end. The distance |z − end|, which decays as
/// exp(−σ0·∫|ω|dt/Fc), changes ω by Fc·|z − end|/(J·|ω|): here by at most 1e-12 of ω.
/// @param deflection z, rad. @param end sgn(ω)·Fc/σ0, rad. @param coulomb Fc, N m. @param inertia J, kg m².
/// @param omega rad/s.
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
/// @param stiffness σ0. @param bristle_damping σ1. @param damping d. @param breakaway g(0), N m.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE auto bristle_rests(const Number& deflection, const Number& omega,
                                           const Number& torque, const Number& stiffness,
                                           const Number& bristle_damping, const Number& damping,
                                           const Number& breakaway, const Number& inertia,
                                           const Number& rest) {
  const Number one(1.0);
  const Number margin = one - abs(torque) / breakaway;
  const Number resistance = bristle_damping * margin + damping;
  const Number frequency = sqrt(stiffness / inertia);
  const Number excursion =
      abs(deflection - torque / stiffness) + abs(omega) * (one / frequency + inertia / resistance);
  return (margin > Number(0.0)) & (resistance > Number(0.0)) &
         (Number(4.0) * excursion * (one + inertia * frequency / resistance) < rest * margin);
}

}  // namespace zerocount::friction
