#pragma once

#include "core/batch/kernels/velocity_step.hpp"
#include "core/friction/bristles/gms_formulas.hpp"

/// Vectorised integration of rotors whose friction consists of elements that stick or slip; see
/// friction::GmsFriction.
namespace zerocount::batch {

/// Access to the Maxwell-slip elements of one vector of lanes, for the formulas of friction::GmsMotion. A
/// lane with fewer elements than the vector's maximum is filled up with elements of stiffness, weight and
/// torque 0, which never slip.
template <class P>
struct LaneElements {
  using State = friction::GmsStateOf<P>;
  P count;
  State states[max_lane_elements];

  template <class At>
  ZEROCOUNT_ALWAYS_INLINE LaneElements(const ElementLanes& e, const At& at)
      : count(select(at.taking_part(), at.load(e.count), P(0.0))) {
    for (int i = 0; any(have(i)); ++i) {
      states[i] = {at.load(e.stiffness[i]), at.load(e.weight[i]), at.load(e.torque[i]),
                   to_mask(at.load(e.slips[i]))};
    }
  }
  /// Mask of the lanes that have an element with the index i.
  ZEROCOUNT_ALWAYS_INLINE typename P::Mask have(int i) const { return count > P(static_cast<double>(i)); }
  template <class Visit>
  ZEROCOUNT_ALWAYS_INLINE void each(Visit visit) const {
    for (int i = 0; any(have(i)); ++i) visit(states[i]);
  }
  template <class Visit>
  ZEROCOUNT_ALWAYS_INLINE void change(Visit visit) {
    for (int i = 0; any(have(i)); ++i) {
      visit(states[i]);
      states[i].slips = states[i].slips & have(i);
    }
  }
  template <class At>
  ZEROCOUNT_ALWAYS_INLINE void store(ElementLanes& e, const At& at) const {
    for (int i = 0; any(have(i)); ++i) {
      at.store(e.torque[i], states[i].torque);
      at.store(e.slips[i], to_number<P>(states[i].slips));
    }
  }
};

/// Applies the rest rule of friction::GmsFriction to one vector of lanes.
/// @returns mask of the lanes whose rotor is at rest.
template <class At>
ZEROCOUNT_ALWAYS_INLINE typename At::Vector::Mask elements_rest(BatchState& batch, const At& at,
                                                                Forcing forcing) {
  using P = typename At::Vector;
  const P omega = at.load(batch.motion.omega);
  const P rest = at.load(batch.time.rest);
  typename P::Mask quiet = rest == rest;
  if (forcing.loaded) quiet = load_is_quiet(batch, at, omega, at.load(batch.elements.softest) * rest, P(0.0));
  LaneElements<P> elements(batch.elements, at);
  const auto rests = friction::rest_on_elements(elements, at.load(batch.motion.torque), omega,
                                                at.load(batch.contact.breakaway),
                                                at.load(batch.contact.inertia), rest, quiet);
  elements.store(batch.elements, at);
  return rests;
}

/// Moves the lanes whose rotor is at rest under a constant torque to their next stop, the next instant at
/// which their torque may change.
/// @returns the lanes that are not at rest.
template <class P>
LaneSet elements_rest_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  MotionLanes& m = batch.motion;
  LaneSet moving = lanes;
  for (int base = 0; base < max_lanes; base += P::lanes) {
    const unsigned here = lanes.stretch(base, P::lanes);
    if (here == 0) continue;
    const LaneStretch<P> all(base, here);
    const unsigned rested = (all.load(m.rest_torque) == all.load(m.torque)).bits() & here;
    unsigned resting = rested;
    if (rested != here)
      resting |= elements_rest(batch, LaneStretch<P>(base, here & ~rested), forcing).bits() & here & ~rested;
    if (resting == 0) continue;
    moving.erase_stretch(base, resting);
    const LaneStretch<P> at(base, resting);
    at.store(m.rest_torque, at.load(m.torque));
    halt_to_next_stop(batch, at, forcing);
  }
  return moving;
}

template <class P>
using ElementSeries = friction::GmsSeriesOf<P[batch_order + 1]>;

/// Finds the first instant within the step at which a sticking element begins to slip.
/// @param x fraction of the step; where an element slips earlier, it is reduced to that instant.
/// @param exact lanes in which the friction level is known as accurately as the torque of the elements.
/// @returns the lanes in which the first slip is uncertain: the margin of an element may have a second zero,
/// or the level is not accurate and an element is near it.
template <class At, class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask find_first_slip(const LaneElements<P>& elements, const P& coulomb,
                                                         const At& at, const ElementSeries<P>& s,
                                                         const P& direction, const typename P::Mask& lanes,
                                                         const typename P::Mask& exact, P& x) {
  using Mask = typename P::Mask;
  const P zero(0.0);
  P excursion = zero;
#pragma GCC unroll 1
  for (int k = batch_order; k >= 1; --k) excursion = excursion + abs(s.position[k]);
  Mask unfit = zero != zero;
  for (int i = 0; any(elements.have(i)); ++i) {
    const friction::GmsStateOf<P>& state = elements.states[i];
    const Mask near = lanes & ~state.slips & elements.have(i) &
                      (direction * state.torque + state.stiffness * excursion >= state.weight * coulomb);
    if (!(near & at.taking_part()).any()) continue;
    P margin[batch_order + 1];
#pragma GCC unroll 1
    for (std::size_t k = 0; k <= batch_order; ++k)
      margin[k] = friction::margin_coefficient(state, direction, s, k);
    const P at_x = value_of(margin, batch_order, x);
    const Mask slips = near & (at_x < zero);
    const P curvature = curvature_bound(margin, batch_order);
    const Mask bends_down = (margin[2] < zero) & crosses_once(margin, batch_order);
    unfit = unfit | (near & ~exact) |
            (near & ~slips & ~bends_down & ~keeps_sign(margin[0], at_x, margin[1], curvature)) |
            (slips & ~crosses_once(margin, batch_order));
    const Mask seeks = slips & ~unfit & at.taking_part();
    if (seeks.any()) x = select(seeks, root_between(margin, batch_order, margin[0], at_x, x, seeks), x);
  }
  return unfit;
}

/// Advances the torques of the elements to the fraction x of the step, in the lanes of step.done.
/// @returns mask of the lanes in which all elements slip.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask move(LaneElements<P>& elements, const ElementSeries<P>& s,
                                              const friction::GmsSums<P>& sums, const VelocityStep<P>& step) {
  const P travel = value_of(s.position, batch_order, step.x);
  const P slipping = value_of(s.slipping, batch_order, step.x);
  const P fading = value_of(s.fading, batch_order, step.x);
  typename P::Mask slides = travel == travel;
  for (int i = 0; any(elements.have(i)); ++i) {
    friction::GmsStateOf<P>& state = elements.states[i];
    const P torque = friction::torque_after(state, sums, travel, slipping, fading);
    state.torque = select(step.done, torque, state.torque);
    state.slips = state.slips & ~(step.done & step.halts);
    slides = slides & (state.slips | ~elements.have(i));
  }
  return slides;
}

/// Integrates one step of one vector of lanes with elements that stick or slip; see elements_kernel().
template <class At>
__attribute__((noinline)) void move_elements(BatchState& batch, const At& at, Forcing forcing) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  const ContactLanes& c = batch.contact;
  const P zero(0.0);
  const P one(1.0);
  const P time_to_stop = at.load(batch.time.time_to_stop);
  const P omega = at.load(batch.motion.omega);
  const P torque = torque_on_rotor(batch, at, forcing, omega);
  const P coulomb = at.load(c.coulomb);
  const P excess = at.load(c.breakaway) - coulomb;
  const P per_inertia = at.load(c.per_inertia);
  const P per_velocity_squared = at.load(c.per_velocity_squared);
  const P stiffest = at.load(batch.elements.stiffest);
  const friction::GmsConstants<P> of{{coulomb, excess, per_velocity_squared},
                                     at.load(batch.elements.attraction),
                                     at.load(c.sliding_damping)};

  LaneElements<P> elements(batch.elements, at);
  const P unbalanced = torque - friction::torque_of_elements<P>(elements);
  const P direction = heading_under(batch, at, forcing, omega, unbalanced);
  const P decay_start = exp(-per_velocity_squared * omega * omega);
  const friction::GmsSums<P> sums =
      friction::begin_to_slip(elements, direction, coulomb + excess * decay_start);

  P h = min(at.load(batch.time.next_step), time_to_stop);
  h = min(h, stribeck_step(omega, abs(unbalanced - of.damping * omega) * per_inertia,
                           one / sqrt(per_velocity_squared), per_velocity_squared));
  h = without_short_remainder(h, time_to_stop);

  ElementSeries<P> s;
  s.position[0] = zero;
  s.omega[0] = omega * h;
  s.slipping[0] = sums.slipping_torque;
  s.fading[0] = one;
  s.decay[0] = decay_start;
  ForcedTorque<P> applied;
  load_torque(batch, at, forcing, h, one, one, applied);
  friction::GmsConstants<P> law = in_unit_of_time(of, h);
  law.attraction = acting_attraction(law, sums);
  expand_motion(
      s, applied, h, torque, per_inertia, [&](std::size_t k, const P& u) __attribute__((always_inline)) {
        return friction::gms_coefficient(law, sums, direction, s, k, u);
      });
  s.expand_level(law.level, s.omega, batch_order);

  const P of_torques = last_terms_of(s.slipping) + last_terms_of(s.fading) * (coulomb + excess);
  VelocityStep<P> step =
      velocity_step(batch, at, time_to_stop, h, last_terms_of(s, applied) + of_torques / stiffest);
  step.too_long = step.inexact | halts_unsurely(s.omega, true, step) | grows_too_much(s.exponent);
  end_at_halt(s.omega, at, step);
  const P halt = step.x;
  const Mask exact = last_terms_of(s.level) <= step.allowed * stiffest;
  step.too_long =
      step.too_long | find_first_slip(elements, coulomb, at, s, direction, ~step.too_long, exact, step.x);
  step.halts = step.halts & (step.x == halt);
  step.done = ~step.too_long;

  store_motion(batch, at, s, applied, omega, step);
  at.store(batch.motion.rest_torque, P(__builtin_nan("")));
  at.store(batch.motion.gradual_slide, to_number<P>(move(elements, s, sums, step)));
  elements.store(batch.elements, at);
  add_events(batch, at, lost_in_steps<P>(batch, at));
}

/// One integration step of each moving lane with elements that stick or slip. The step ends at the lane's
/// next stop (at which its torque may change), at ω = 0, at the first slip of an element, or where the Taylor
/// series cease to be accurate. Reports beyond_kernel for lanes that it cannot compute. See
/// friction::GmsMotion.
template <class V>
void elements_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  batch.event_count = 0;
  for_each_group<typename V::Wide>(lanes, [&](const auto& at) { move_elements(batch, at, forcing); });
}

}  // namespace zerocount::batch
