#pragma once

#include "core/batch/kernels/coupled_torque.hpp"
#include "core/batch/kernels/velocity_step.hpp"

/// Lanes with elements that stick or slip; see friction::GmsFriction.
namespace zerocount::batch {

/// Calls `visit` with the index of each element that a lane of the vector has. Beyond its own a lane has
/// elements of stiffness, weight and torque 0, which never slip.
template <class At, class Visit>
ZEROCOUNT_ALWAYS_INLINE void for_each_element(const BatchState& batch, const At& at, Visit visit) {
  using P = typename At::Vector;
  const P count = select(at.taking_part(), at.load(batch.elements.count), P(0.0));
  for (int i = 0; i < max_lane_elements && (count > P(static_cast<double>(i))).any(); ++i) visit(i);
}

/// The lanes that have an element of this index.
template <class At>
ZEROCOUNT_ALWAYS_INLINE typename At::Vector::Mask have_element(const BatchState& batch, const At& at, int i) {
  return at.load(batch.elements.count) > typename At::Vector(static_cast<double>(i));
}

/// The sum of the torques of all elements, N m.
template <class At>
ZEROCOUNT_ALWAYS_INLINE typename At::Vector torque_of_elements(const BatchState& batch, const At& at) {
  typename At::Vector sum(0.0);
  for_each_element(batch, at, [&](int i) { sum = sum + at.load(batch.elements.torque[i]); });
  return sum;
}

/// The rest rule of GmsFriction, of one vector: the elements that carry a rotor at rest take over what the
/// torque exceeds theirs by. @returns the lanes at rest.
template <class At>
ZEROCOUNT_ALWAYS_INLINE typename At::Vector::Mask rest_on_elements(BatchState& batch, const At& at,
                                                                   Forcing forcing) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  ElementLanes& e = batch.elements;
  const P zero(0.0);
  const P omega = at.load(batch.motion.omega);
  const P torque = at.load(batch.motion.torque);
  const P rest = at.load(batch.time.rest);
  const P level = at.load(batch.contact.breakaway);
  const auto holds = [&](int i) {
    return abs(at.load(e.torque[i])) + at.load(e.stiffness[i]) * rest < at.load(e.weight[i]) * level;
  };
  P stiffness = zero;
  Mask sticks = zero == zero;
  for_each_element(batch, at, [&](int i) {
    sticks = sticks & (at.load(e.slips[i]) == zero);
    stiffness = stiffness + select(holds(i), at.load(e.stiffness[i]), zero);
  });
  const P shift = (torque - torque_of_elements(batch, at)) / stiffness;
  Mask rests = sticks & (stiffness > zero) &
               (abs(shift) + abs(omega) * sqrt(at.load(batch.contact.inertia) / stiffness) < rest);
  if (forcing.loaded) rests = rests & load_is_quiet(batch, at, omega, at.load(e.softest) * rest, zero);
  for_each_element(batch, at, [&](int i) {
    const P carried = at.load(e.torque[i]);
    at.store(e.torque[i], select(rests & holds(i), carried + at.load(e.stiffness[i]) * shift, carried));
  });
  return rests;
}

/// Moves the lanes that are at rest under their torque, which stays, to their next stop. @returns the others.
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
      resting |=
          rest_on_elements(batch, LaneStretch<P>(base, here & ~rested), forcing).bits() & here & ~rested;
    if (resting == 0) continue;
    moving.erase_stretch(base, resting);
    const LaneStretch<P> at(base, resting);
    at.store(m.rest_torque, at.load(m.torque));
    halt_to_next_stop(batch, at, forcing);
  }
  return moving;
}

/// What the elements of a vector do in a step.
template <class P>
struct ElementSums {
  P sticking_torque;     ///< N m
  P sticking_stiffness;  ///< N m/rad
  P slipping_torque;     ///< N m
  P slipping_weight;
};

/// Lets the elements slip that have come to their level in this direction, and sums all up.
/// @param level g(ω), N m.
template <class At, class P = typename At::Vector>
ZEROCOUNT_ALWAYS_INLINE ElementSums<P> begin_to_slip(BatchState& batch, const At& at, const P& direction,
                                                     const P& level) {
  ElementLanes& e = batch.elements;
  const P zero(0.0);
  ElementSums<P> sums{zero, zero, zero, zero};
  for_each_element(batch, at, [&](int i) {
    const P before = at.load(e.torque[i]);
    const P weight = at.load(e.weight[i]);
    const P highest = weight * level;
    const auto slipped = to_mask(at.load(e.slips[i]));
    const auto begins = ~slipped & have_element(batch, at, i) & (direction != zero) &
                        ~(direction * before < P(1.0 - 1e-12) * highest);
    const auto slips = slipped | begins;
    const P torque = select(begins, direction * highest, before);
    at.store(e.torque[i], torque);
    at.store(e.slips[i], to_number<P>(slips));
    sums.sticking_torque = sums.sticking_torque + select(slips, zero, torque);
    sums.sticking_stiffness = sums.sticking_stiffness + select(slips, zero, at.load(e.stiffness[i]));
    sums.slipping_torque = sums.slipping_torque + select(slips, torque, zero);
    sums.slipping_weight = sums.slipping_weight + select(slips, weight, zero);
  });
  return sums;
}

/// The series of a step, and what bounds them over it.
template <class P>
struct ElementSeries {
  P travel[batch_order + 1];    ///< rad
  P velocity[batch_order + 1];  ///< ω·h, rad
  P level[batch_order + 1];     ///< g(ω), N m
  P slipping[batch_order + 1];  ///< torque of all slipping elements, N m
  P fading[batch_order + 1];    ///< E of GmsMotion
};

/// Finds the first slip of an element before the fraction x of the step. @param x is moved there. @param
/// exact lanes in which the level is as accurate as the torque of the elements. @returns the lanes in which
/// the first slip is not known: a margin may have a second zero, or the level is not accurate and an element
/// is near it.
template <class At, class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask find_first_slip(const BatchState& batch, const At& at,
                                                         const ElementSeries<P>& s, const P& direction,
                                                         const typename P::Mask& lanes,
                                                         const typename P::Mask& exact, P& x) {
  using Mask = typename P::Mask;
  const ElementLanes& e = batch.elements;
  const P zero(0.0);
  const P one(1.0);
  const P coulomb = at.load(batch.contact.coulomb);
  P excursion = zero;
#pragma GCC unroll 1
  for (int k = batch_order; k >= 1; --k) excursion = excursion + abs(s.travel[k]);
  Mask unfit = one < zero;
  for_each_element(batch, at, [&](int i) {
    const P weight = at.load(e.weight[i]);
    const P stiffness = direction * at.load(e.stiffness[i]);
    const P carried = direction * at.load(e.torque[i]);
    const Mask near = lanes & (at.load(e.slips[i]) == zero) & have_element(batch, at, i) &
                      (carried + abs(stiffness) * excursion >= weight * coulomb);
    if (!(near & at.taking_part()).any()) return;
    P margin[batch_order + 1];
    margin[0] = weight * s.level[0] - carried;
#pragma GCC unroll 1
    for (int k = 1; k <= batch_order; ++k) margin[k] = weight * s.level[k] - stiffness * s.travel[k];
    const P at_x = value_of(margin, batch_order, x);
    const Mask slips = near & (at_x < zero);
    const P curvature = curvature_bound(margin, batch_order);
    const Mask bends_down = (margin[2] < zero) & crosses_once(margin, batch_order);
    unfit = unfit | (near & ~exact) |
            (near & ~slips & ~bends_down & ~keeps_sign(margin[0], at_x, margin[1], curvature)) |
            (slips & ~crosses_once(margin, batch_order));
    const Mask seeks = slips & ~unfit & at.taking_part();
    if (seeks.any()) x = select(seeks, root_between(margin, batch_order, margin[0], at_x, x, seeks), x);
  });
  return unfit;
}

/// Stores the elements at the fraction x of the step, in the lanes of step.done.
template <class At, class P>
ZEROCOUNT_ALWAYS_INLINE void store_elements(BatchState& batch, const At& at, const ElementSeries<P>& s,
                                            const ElementSums<P>& sums, const VelocityStep<P>& step) {
  ElementLanes& e = batch.elements;
  const P zero(0.0);
  const P travel = value_of(s.travel, batch_order, step.x);
  const P slipping = value_of(s.slipping, batch_order, step.x);
  const P fading = value_of(s.fading, batch_order, step.x);
  auto slides = zero == zero;
  for_each_element(batch, at, [&](int i) {
    const P before = at.load(e.torque[i]);
    const P weight = at.load(e.weight[i]);
    const auto slips = to_mask(at.load(e.slips[i]));
    const P part = weight / sums.slipping_weight;
    const P relaxed = part * slipping + (before - part * sums.slipping_torque) * fading;
    const P loaded = before + at.load(e.stiffness[i]) * travel;
    at.store(e.torque[i], select(step.done, select(slips, relaxed, loaded), before));
    const auto still_slips = slips & ~(step.done & step.halts);
    at.store(e.slips[i], to_number<P>(still_slips));
    slides = slides & (still_slips | ~have_element(batch, at, i));
  });
  at.store(batch.motion.gradual_slide, to_number<P>(slides));
}

/// The step of one vector; see elements_kernel.
template <class At>
__attribute__((noinline)) void move_elements(BatchState& batch, const At& at, Forcing forcing) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  MotionLanes& m = batch.motion;
  const ContactLanes& c = batch.contact;
  TimeLanes& time = batch.time;
  const P zero(0.0);
  const P one(1.0);
  const P time_to_stop = at.load(time.time_to_stop);
  const P omega = at.load(m.omega);
  const P torque = torque_on_rotor(batch, at, forcing, omega);
  const P damping = at.load(c.sliding_damping);
  const P coulomb = at.load(c.coulomb);
  const P excess = at.load(c.breakaway) - coulomb;
  const P per_inertia = at.load(c.per_inertia);
  const P per_velocity_squared = at.load(c.per_velocity_squared);
  const P stiffest = at.load(batch.elements.stiffest);

  const Mask from_zero = omega == zero;
  const P all_torque = torque_of_elements(batch, at);
  P direction = sign(select(from_zero, torque - all_torque, omega));
  if (forcing.varies) {
    direction = select(direction == zero, sign(torque_rate(batch, at, omega)), direction);
  }
  const P decay_start = exp(-per_velocity_squared * omega * omega);
  const P level_start = coulomb + excess * decay_start;
  const ElementSums<P> sums = begin_to_slip(batch, at, direction, level_start);

  const P unbalanced = torque - all_torque - damping * omega;
  P h = min(at.load(time.next_step), time_to_stop);
  h = min(h, stribeck_step(omega, abs(unbalanced) * per_inertia, one / sqrt(per_velocity_squared),
                           per_velocity_squared));
  h = without_short_remainder(h, time_to_stop);
  const P force_scale = h * h * per_inertia;
  const P damping_scale = h * per_inertia * damping;
  const P per_step_squared = per_velocity_squared / (h * h);
  // Where g is constant, slipping elements stay at its level.
  const Mask relaxes = (sums.slipping_weight > zero) & (excess != zero);
  const P attraction = select(relaxes, at.load(batch.elements.attraction) * h, zero);
  const bool some_relax = (relaxes & at.taking_part()).any();

  ElementSeries<P> s;
  P slipping_ratio[batch_order + 1];
  P fading_ratio[batch_order + 1];
  friction::StribeckSeriesOf<P[batch_order + 1]> curve;
  s.travel[0] = zero;
  s.velocity[0] = omega * h;
  s.slipping[0] = sums.slipping_torque;
  s.fading[0] = one;
  curve.decay[0] = decay_start;
  ForcedTorque<P> applied;
  load_torque(batch, at, forcing, h, one, one, applied);
#pragma GCC unroll 1
  for (int k = 0; k < batch_order; ++k) {
    const auto order = static_cast<std::size_t>(k);
    const P per_order = P(numerics::reciprocal.of[k + 1]);
    curve.expand(per_step_squared, s.velocity, order);
    s.level[k] = excess * curve.decay[k] + (k == 0 ? coulomb : zero);
    s.slipping[k + 1] = s.fading[k + 1] = zero;
    if (some_relax) {
      slipping_ratio[k] = numerics::quotient_coefficient(s.slipping[k], s.level, slipping_ratio, order);
      fading_ratio[k] = numerics::quotient_coefficient(s.fading[k], s.level, fading_ratio, order);
      const P driven = k == 0 ? direction * sums.slipping_weight : zero;
      s.slipping[k + 1] = attraction * per_order * (driven - slipping_ratio[k]);
      s.fading[k + 1] = -(attraction * per_order * fading_ratio[k]);
    }
    const P varying = applied.coefficient(k, s.velocity[k]);
    const P torque_k = k == 0 ? torque - sums.sticking_torque : varying;
    const P force = torque_k - sums.sticking_stiffness * s.travel[k] - s.slipping[k];
    s.travel[k + 1] = s.velocity[k] * per_order;
    s.velocity[k + 1] = (force_scale * force - damping_scale * s.velocity[k]) * per_order;
  }
  curve.expand(per_step_squared, s.velocity, batch_order);
  s.level[batch_order] = excess * curve.decay[batch_order];

  const P of_torques = last_terms_of(s.slipping) + last_terms_of(s.fading) * (coulomb + excess);
  const P of_rotor = last_terms_of(s.travel) + last_terms_of(s.velocity) + of_torques / stiffest;
  const P last_terms = of_rotor + last_terms_of_load(applied);
  VelocityStep<P> step = velocity_step(batch, at, time_to_stop, h, last_terms);

  const P velocity_start = select(from_zero, s.velocity[1], s.velocity[0]);
  const P velocity_end = sum_of(s.velocity, batch_order);
  step.halts = velocity_start * velocity_end < zero;
  // Neither ω, nor ω/t where ω starts at 0, may have two zeros within the step.
  P signed_part[batch_order + 1];
  for (int k = 0; k < batch_order; ++k) signed_part[k] = select(from_zero, s.velocity[k + 1], s.velocity[k]);
  signed_part[batch_order] = select(from_zero, zero, s.velocity[batch_order]);
  const P curvature = curvature_bound(signed_part, batch_order);
  Mask unfit = (~step.halts & ~keeps_sign(signed_part[0], velocity_end, signed_part[1], curvature)) |
               (step.halts & ~crosses_once(signed_part, batch_order));
  // A rotor that nothing moves keeps still.
  unfit = unfit & ((curvature > zero) | (signed_part[1] != zero));
  unfit = unfit | grows_too_much(curve.exponent);
  step.too_long = step.inexact | unfit;
  const Mask seeks = at.taking_part() & step.halts & ~step.too_long;
  if (seeks.any()) {
    step.x = select(step.halts,
                    next_zero(s.velocity, batch_order, velocity_start, velocity_end, from_zero, seeks), one);
  }
  const P halt = step.x;
  const Mask exact = last_terms_of(s.level) <= step.allowed * stiffest;
  step.too_long = step.too_long | find_first_slip(batch, at, s, direction, ~step.too_long, exact, step.x);
  step.halts = step.halts & (step.x == halt);
  step.done = ~step.too_long;
  store_time(batch, at, step);

  at.store(m.theta, at.load(m.theta) + select(step.done, value_of(s.travel, batch_order, step.x), zero));
  at.store(m.omega, omega_after(step, s.velocity, omega));
  at.store(m.rest_torque, P(__builtin_nan("")));
  store_elements(batch, at, s, sums, step);
  store_load(batch, at, applied, step.x, step.h, step.done);
  add_events(batch, at, events_where<P>(at.load(time.steps) > P(max_steps_to_stop), beyond_kernel));
}

/// One step of each moving lane with elements: to the next stop, to ω = 0, to the slip of an element, or as
/// far as the series converge. Reports beyond_kernel. See friction::GmsMotion.
template <class V>
void elements_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  batch.event_count = 0;
  for_each_group<typename V::Wide>(lanes, [&](const auto& at) { move_elements(batch, at, forcing); });
}

}  // namespace zerocount::batch
