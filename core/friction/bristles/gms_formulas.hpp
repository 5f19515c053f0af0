#pragma once

#include "core/friction/sliding/slide_formulas.hpp"

/// The law of elements that stick or slip (GmsMotion), for double and for the vectors of the batch engine.
///
/// `Elements` has all elements of a rotor: each(visit) passes them to visit(state), and change(visit) lets it
/// change them.
namespace zerocount::friction {

/// An element of the Maxwell-slip model with its state.
template <class Number>
struct GmsStateOf {
  Number stiffness;  ///< κi, N m/rad
  Number weight;     ///< ηi
  Number torque;     ///< Fi, N m
  decltype(Number(0.0) < Number(0.0)) slips;
};

template <class Number>
struct GmsConstants {
  StribeckCurveOf<Number> level;  ///< g
  Number attraction;              ///< C, N m/s
  Number damping;                 ///< cs, N m s/rad
};

/// The constants with times in the unit of h (s).
template <class Number>
ZEROCOUNT_ALWAYS_INLINE GmsConstants<Number> in_unit_of_time(const GmsConstants<Number>& of,
                                                             const Number& h) {
  return {in_unit_of_time(of.level, h), of.attraction * h, of.damping / h};
}

/// Sums over the sticking elements, and over the slipping elements.
template <class Number>
struct GmsSums {
  Number sticking_torque;     ///< N m
  Number sticking_stiffness;  ///< N m/rad
  Number slipping_torque;     ///< N m
  Number slipping_weight;     ///< Sum H of the weights ηi of the slipping elements
};

/// Torque of all elements, Σ Fi, N m.
template <class Number, class Elements>
ZEROCOUNT_ALWAYS_INLINE Number torque_of_elements(const Elements& elements) {
  Number sum(0.0);
  elements.each([&](const GmsStateOf<Number>& state) { sum = sum + state.torque; });
  return sum;
}

/// Sets elements within rounding of their level in this direction to the level; they slip.
/// @param direction s, or 0. @param level g(ω), N m. @returns the sums afterwards.
template <class Number, class Elements>
ZEROCOUNT_ALWAYS_INLINE GmsSums<Number> begin_to_slip(Elements& elements, const Number& direction,
                                                      const Number& level) {
  constexpr double rounding = 1e-12;
  const Number zero(0.0);
  GmsSums<Number> sums{zero, zero, zero, zero};
  elements.change([&](GmsStateOf<Number>& state) {
    const Number highest = state.weight * level;
    const auto begins = negated(state.slips) & (direction != zero) &
                        negated(direction * state.torque < Number(1.0 - rounding) * highest);
    const auto slips = state.slips | begins;
    state.torque = select(begins, direction * highest, state.torque);
    state.slips = slips;
    sums.sticking_torque = sums.sticking_torque + select(slips, zero, state.torque);
    sums.sticking_stiffness = sums.sticking_stiffness + select(slips, zero, state.stiffness);
    sums.slipping_torque = sums.slipping_torque + select(slips, state.torque, zero);
    sums.slipping_weight = sums.slipping_weight + select(slips, state.weight, zero);
  });
  return sums;
}

/// The rest rule of GmsFriction. If the rotor is at rest, the elements that hold it take over the difference
/// between the torque and ΣFi. @param level g(0), N m. @param rest ε, rad. @returns whether the rotor is at
/// rest.
template <class Number, class Elements, class Mask>
ZEROCOUNT_ALWAYS_INLINE Mask rest_on_elements(Elements& elements, const Number& torque, const Number& omega,
                                              const Number& level, const Number& inertia, const Number& rest,
                                              const Mask& load_is_quiet) {
  const auto holds = [&](const GmsStateOf<Number>& state) {
    return abs(state.torque) + state.stiffness * rest < state.weight * level;
  };
  const Number zero(0.0);
  Number stiffness = zero;
  Mask slips = zero != zero;
  elements.each([&](const GmsStateOf<Number>& state) {
    slips = slips | state.slips;
    stiffness = stiffness + select(holds(state), state.stiffness, zero);
  });
  const Number shift = (torque - torque_of_elements<Number>(elements)) / stiffness;
  const Mask rests = load_is_quiet & negated(slips) & (stiffness > zero) &
                     (abs(shift) + abs(omega) * sqrt(inertia / stiffness) < rest);
  elements.change([&](GmsStateOf<Number>& state) {
    state.torque = select(rests & holds(state), state.torque + state.stiffness * shift, state.torque);
  });
  return rests;
}

/// Taylor series of the elements and their rotor. @tparam Series an array of the coefficients.
template <class Series>
struct GmsSeriesOf : LevelSeriesOf<Series> {
  Series position;        ///< Travel since the start of the step, rad
  Series omega;           ///< ω, rad/s
  Series slipping;        ///< Torque of all slipping elements, N m
  Series slipping_ratio;  ///< slipping/g(ω)
  Series fading;          ///< Decay factor E of GmsMotion, dimensionless
  Series fading_ratio;    ///< fading/g(ω), 1/(N m)
};

/// Attraction C if there are slipping elements that relax, else 0. If g is constant, slipping elements stay
/// at its level and do not relax.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number acting_attraction(const GmsConstants<Number>& of,
                                                 const GmsSums<Number>& sums) {
  const Number zero(0.0);
  return select((sums.slipping_weight > zero) & (of.level.excess != zero), of.attraction, zero);
}

/// Computes coefficients k of functions of the state, and k + 1 of the state except ω.
/// @param of constants of the law, with acting_attraction() as the attraction. @param direction s. @param
/// torque coefficient k of u. @returns coefficient k of u − ΣFi − cs·ω.
template <class Number, class Series>
ZEROCOUNT_ALWAYS_INLINE Number gms_coefficient(const GmsConstants<Number>& of, const GmsSums<Number>& sums,
                                               const Number& direction, GmsSeriesOf<Series>& s, std::size_t k,
                                               const Number& torque) {
  const Number zero(0.0);
  const Number per_order(numerics::reciprocal.of[k + 1]);
  s.expand_level(of.level, &s.omega[0], k);
  s.slipping[k + 1] = s.fading[k + 1] = zero;
  if (any(of.attraction > zero)) {
    const Number rate = of.attraction * per_order;
    s.slipping_ratio[k] = numerics::quotient_coefficient(s.slipping[k], &s.level[0], &s.slipping_ratio[0], k);
    s.fading_ratio[k] = numerics::quotient_coefficient(s.fading[k], &s.level[0], &s.fading_ratio[0], k);
    s.slipping[k + 1] = rate * ((k == 0 ? direction * sums.slipping_weight : zero) - s.slipping_ratio[k]);
    s.fading[k + 1] = -rate * s.fading_ratio[k];
  }
  s.position[k + 1] = s.omega[k] * per_order;
  const Number sticking = k == 0 ? sums.sticking_torque : sums.sticking_stiffness * s.position[k];
  return torque - sticking - s.slipping[k] - of.damping * s.omega[k];
}

/// Coefficient k of the margin ηi·g(ω) − s·Fi of a sticking element.
template <class Number, class Series>
ZEROCOUNT_ALWAYS_INLINE Number margin_coefficient(const GmsStateOf<Number>& state, const Number& direction,
                                                  const GmsSeriesOf<Series>& s, std::size_t k) {
  return state.weight * s.level[k] - direction * (k == 0 ? state.torque : state.stiffness * s.position[k]);
}

/// Torque Fi of an element after a travel (rad). @param slipping, fading values of GmsSeriesOf::slipping and
/// fading after that travel.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number torque_after(const GmsStateOf<Number>& state, const GmsSums<Number>& sums,
                                            const Number& travel, const Number& slipping,
                                            const Number& fading) {
  const Number part = state.weight / sums.slipping_weight;
  return select(state.slips, part * slipping + (state.torque - part * sums.slipping_torque) * fading,
                state.torque + state.stiffness * travel);
}

}  // namespace zerocount::friction
