#pragma once

#include "core/friction/sliding/slide_formulas.hpp"

/// Formulas of a friction law whose elements stick or slip (GmsMotion), as templates for double and for the
/// vectors of the batch engine.
///
/// The template parameter `Elements` gives access to all elements of a rotor: each(visit) passes them to
/// visit(state), and change(visit) lets visit change them.
namespace zerocount::friction {

/// One element of the generalised Maxwell-slip friction model, a spring that sticks or slips, with its state.
template <class Number>
struct GmsStateOf {
  Number stiffness;  ///< Stiffness κi of the element, N m/rad
  Number weight;     ///< Proportion ηi of the friction level that the element carries
  Number torque;     ///< Torque Fi of the element, N m
  decltype(Number(0.0) < Number(0.0)) slips;
};

template <class Number>
struct GmsConstants {
  StribeckCurveOf<Number> level;  ///< Friction level g(ω)
  Number attraction;              ///< Attraction C, the rate at which a slipping element's torque goes to its
                                  /// < level, N m/s
  Number damping;                 ///< Viscous damping cs, N m s/rad
};

/// The constants converted to the time unit h (s), so that time derivatives are per h.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE GmsConstants<Number> in_unit_of_time(const GmsConstants<Number>& of,
                                                             const Number& h) {
  return {in_unit_of_time(of.level, h), of.attraction * h, of.damping / h};
}

/// Sums over the sticking and over the slipping Maxwell-slip elements of a contact.
template <class Number>
struct GmsSums {
  Number sticking_torque;     ///< Sum of the torques of the sticking elements, N m
  Number sticking_stiffness;  ///< Sum of the stiffnesses of the sticking elements, N m/rad
  Number slipping_torque;     ///< Sum of the torques of the slipping elements, N m
  Number slipping_weight;     ///< Sum H of the weights ηi of the slipping elements
};

/// Torque of all Maxwell-slip elements together, Σ Fi, N m.
template <class Number, class Elements>
ZEROCOUNT_ALWAYS_INLINE Number torque_of_elements(const Elements& elements) {
  Number sum(0.0);
  elements.each([&](const GmsStateOf<Number>& state) { sum = sum + state.torque; });
  return sum;
}

/// Lets the elements slip whose torque equals, within rounding, the level at which they slip in this
/// direction; their torque is set to that level.
/// @param direction sign s of the motion, or 0.
/// @param level friction level g(ω), N m.
/// @returns the sums over all elements afterwards.
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

/// Applies the rest rule of GmsFriction. If the rotor is at rest, the elements that hold it take over the
/// difference between the torque and ΣFi.
/// @param torque torque on the rotor, N m.
/// @param omega ω, rad/s.
/// @param level g(0), N m.
/// @param rest largest travel ε that counts as rest, rad.
/// @param load_is_quiet whether a second mass, if any, permits rest.
/// @returns whether the rotor is at rest.
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

/// Taylor series of the elements and their rotor.
/// @tparam Series an array of the coefficients.
template <class Series>
struct GmsSeriesOf : LevelSeriesOf<Series> {
  Series position;        ///< Travel of the rotor since the start of the step, rad
  Series omega;           ///< Rotor velocity ω, rad/s
  Series slipping;        ///< Torque of all slipping elements divided by the friction level, slipping/g(ω)
  Series slipping_ratio;  ///< slipping/g(ω)
  Series fading;          ///< Decay factor E, from 1, by which slipping elements approach their levels
                          /// < (GmsMotion), dimensionless
  Series fading_ratio;    ///< Decay factor E divided by the friction level, fading/g(ω), 1/(N m)
};

/// Attraction C of the law if there are slipping elements that relax, otherwise 0. If the friction level g is
/// constant, slipping elements stay at their level and do not relax.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number acting_attraction(const GmsConstants<Number>& of,
                                                 const GmsSums<Number>& sums) {
  const Number zero(0.0);
  return select((sums.slipping_weight > zero) & (of.level.excess != zero), of.attraction, zero);
}

/// Computes the Taylor coefficients k of functions of the state, and k + 1 of the state except ω.
/// @param of constants of the law, with acting_attraction() as the attraction.
/// @param direction sign s of the motion.
/// @param torque coefficient k of the torque u on the rotor.
/// @returns coefficient k of the accelerating torque u − ΣFi − cs·ω.
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

/// Taylor coefficient k of a sticking element's margin to slipping, ηi·g(ω) − s·Fi.
/// @param direction sign s of the motion.
template <class Number, class Series>
ZEROCOUNT_ALWAYS_INLINE Number margin_coefficient(const GmsStateOf<Number>& state, const Number& direction,
                                                  const GmsSeriesOf<Series>& s, std::size_t k) {
  return state.weight * s.level[k] - direction * (k == 0 ? state.torque : state.stiffness * s.position[k]);
}

/// Torque Fi of an element after a travel of the rotor (rad).
/// @param slipping, fading values of GmsSeriesOf::slipping and GmsSeriesOf::fading after that travel.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number torque_after(const GmsStateOf<Number>& state, const GmsSums<Number>& sums,
                                            const Number& travel, const Number& slipping,
                                            const Number& fading) {
  const Number part = state.weight / sums.slipping_weight;
  return select(state.slips, part * slipping + (state.torque - part * sums.slipping_torque) * fading,
                state.torque + state.stiffness * travel);
}

}  // namespace zerocount::friction
