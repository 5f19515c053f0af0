#pragma once

#include "core/batch/kernels/coupled_torque.hpp"
#include "core/batch/kernels/velocity_step.hpp"
#include "core/friction/bristles/bristle_formulas.hpp"

namespace zerocount::batch {

/// Which lanes are at rest under their torque.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask rests_on_bristle(const BatchState& batch, const At& at) {
  const MotionLanes& m = batch.motion;
  const ContactLanes& c = batch.contact;
  const P omega = at.load(m.omega);
  const P torque = at.load(m.torque);
  const P deflection = at.load(m.elongation);
  const P stiffness = at.load(c.bristle_stiffness);
  const typename P::Mask balanced = (omega == P(0.0)) & (deflection == torque / stiffness);
  return balanced | friction::bristle_rests(deflection, omega, torque, stiffness, at.load(c.bristle_damping),
                                            at.load(c.sliding_damping), at.load(c.breakaway),
                                            at.load(c.inertia), at.load(batch.time.rest));
}

/// Moves the lanes that are at rest to their next stop. @returns the others.
template <class P>
LaneSet bristle_rest_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  MotionLanes& m = batch.motion;
  LaneSet moving = lanes;
  for (int base = 0; base < max_lanes; base += P::lanes) {
    const unsigned here = lanes.stretch(base, P::lanes);
    if (here == 0) continue;
    const LaneStretch<P> all(base, here);
    typename P::Mask rests = rests_on_bristle<P>(batch, all);
    if (forcing.loaded) {
      const P quiet = all.load(batch.contact.bristle_stiffness) * all.load(batch.time.rest);
      rests = rests & load_is_quiet(batch, all, all.load(m.omega), quiet, P(0.0));
    }
    const unsigned resting = rests.bits() & here;
    if (resting == 0) continue;
    moving.erase_stretch(base, resting);
    const LaneStretch<P> at(base, resting);
    at.store(m.elongation, at.load(m.torque) / at.load(batch.contact.bristle_stiffness));
    halt_to_next_stop(batch, at, forcing);
  }
  return moving;
}

/// The step of one vector; see bristle_kernel.
template <bool Fast, class At>
__attribute__((noinline)) void bristle(BatchState& batch, const At& at, Forcing forcing) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  MotionLanes& m = batch.motion;
  ContactLanes& c = batch.contact;
  TimeLanes& time = batch.time;
  const P zero(0.0);
  const P one(1.0);
  const P time_to_stop = at.load(time.time_to_stop);
  const P omega = at.load(m.omega);
  const P deflection_start = at.load(m.elongation);
  const P torque = torque_on_rotor(batch, at, forcing, omega);
  const P stiffness = at.load(c.bristle_stiffness);
  const P bristle_damping = at.load(c.bristle_damping);
  const P damping = at.load(c.sliding_damping);
  const P coulomb = at.load(c.coulomb);
  const P excess = at.load(c.breakaway) - coulomb;
  const P per_inertia = at.load(c.per_inertia);
  const P per_velocity_squared = at.load(c.per_velocity_squared);

  const Mask from_zero = omega == zero;
  P direction = sign(select(from_zero, torque - stiffness * deflection_start, omega));
  if (forcing.varies) {
    direction = select(direction == zero, sign(torque_rate(batch, at, omega)), direction);
  }
  const P speed = abs(omega);
  const P stribeck_velocity = one / sqrt(per_velocity_squared);
  P decay_start = zero;
  P h = min(at.load(time.next_step), time_to_stop);
  if constexpr (Fast) {
    P max_torque = max(stiffness * abs(deflection_start), coulomb + excess) + abs(torque);
    if (forcing.varies) max_torque = max_torque + torque_range(batch, at, h);
    const P slowing = (max_torque + (damping + P(2.0) * bristle_damping) * speed) * per_inertia;
    h = select(excess > zero, fast_step(speed, stribeck_velocity, slowing, h), h);
  } else {
    decay_start = exp(-per_velocity_squared * omega * omega);
    const P rate =
        omega - direction * stiffness * omega * deflection_start / (coulomb + excess * decay_start);
    const P unbalanced = torque - stiffness * deflection_start - bristle_damping * rate - damping * omega;
    h = min(h, stribeck_step(omega, abs(unbalanced) * per_inertia, stribeck_velocity, per_velocity_squared));
  }
  h = without_short_remainder(h, time_to_stop);
  const P force_scale = h * h * per_inertia;
  const P damping_scale = h * per_inertia;
  const P per_step_squared = per_velocity_squared / (h * h);
  const P end_of_bristle = direction * coulomb / stiffness;
  const Mask saturated =
      friction::is_at_end(deflection_start, end_of_bristle, coulomb, at.load(c.inertia), omega);
  const P towards = direction * stiffness;
  const P per_coulomb = towards / coulomb;

  P travel[batch_order + 1];
  P velocity[batch_order + 1];
  P deflection[batch_order + 1];  // z
  P ratio[batch_order + 1];       // ω·z/g
  friction::StribeckSeriesOf<P[batch_order + 1]> curve;
  P level[batch_order + 1];
  travel[0] = zero;
  velocity[0] = omega * h;
  deflection[0] = Fast ? select(saturated, end_of_bristle, deflection_start) : deflection_start;
  curve.decay[0] = decay_start;
  ForcedTorque<P> applied;
  load_torque(batch, at, forcing, h, one, one, applied);
#pragma GCC unroll 1
  for (int k = 0; k < batch_order; ++k) {
    const auto order = static_cast<std::size_t>(k);
    P rate;
    if constexpr (Fast) {
      rate = velocity[k] - per_coulomb * numerics::product_coefficient(velocity, deflection, order);
    } else {
      curve.expand(per_step_squared, velocity, order);
      level[k] = excess * curve.decay[k] + (k == 0 ? coulomb : zero);
      rate = friction::bristle_rate_coefficient(towards, velocity, deflection, level, ratio, order);
    }
    if constexpr (Fast) rate = select(saturated, zero, rate);
    const P per_order = P(numerics::reciprocal.of[k + 1]);
    const P varying = applied.coefficient(k, velocity[k]);
    const P force = (k == 0 ? torque : varying) - stiffness * deflection[k];
    travel[k + 1] = velocity[k] * per_order;
    deflection[k + 1] = rate * per_order;
    velocity[k + 1] =
        (force_scale * force - damping_scale * (bristle_damping * rate + damping * velocity[k])) * per_order;
  }

  const P of_rotor = (last_terms_of(travel) + last_terms_of(velocity)) + last_terms_of(deflection);
  const P last_terms = of_rotor + last_terms_of_load(applied);
  VelocityStep<P> step = velocity_step(batch, at, time_to_stop, h, last_terms);
  const P velocity_start = select(from_zero, velocity[1], velocity[0]);
  const P velocity_end = sum_of(velocity, batch_order);
  step.halts = velocity_start * velocity_end < zero;
  // Neither ω, nor ω/t where ω starts at 0, may have two zeros within the step.
  P signed_part[batch_order + 1];
  for (int k = 0; k < batch_order; ++k) signed_part[k] = select(from_zero, velocity[k + 1], velocity[k]);
  signed_part[batch_order] = select(from_zero, zero, velocity[batch_order]);
  Mask unfit = ~step.halts & ~keeps_sign(signed_part[0], velocity_end, signed_part[1],
                                         curvature_bound(signed_part, batch_order));
  if (forcing.any()) {
    unfit = unfit | (step.halts & ~crosses_once(signed_part, batch_order));
    // A rotor that nothing moves keeps still.
    unfit = unfit & ((curvature_bound(signed_part, batch_order) > zero) | (signed_part[1] != zero));
  }
  if constexpr (!Fast) unfit = unfit | grows_too_much(curve.exponent);
  if (Fast && forcing.loaded) unfit = unfit | ((excess > zero) & ~stays_fast(velocity, stribeck_velocity, h));
  step.too_long = step.inexact | unfit;
  step.done = ~step.too_long;
  const Mask seeks = at.taking_part() & step.halts & step.done;
  if (seeks.any()) {
    step.x = select(step.halts,
                    next_zero(velocity, batch_order, velocity_start, velocity_end, from_zero, seeks), one);
  }
  store_time(batch, at, step);

  const P omega_end = omega_after(step, velocity, omega);
  const P deflection_end = select(step.done, value_of(deflection, batch_order, step.x), deflection_start);
  const P level_end = Fast ? coulomb : coulomb + excess * exp(-per_velocity_squared * omega_end * omega_end);
  at.store(m.theta, at.load(m.theta) + select(step.done, value_of(travel, batch_order, step.x), zero));
  at.store(m.omega, omega_end);
  at.store(m.elongation, deflection_end);
  at.store(m.gradual_slide, to_number<P>(friction::bristle_slides(deflection_end, omega_end, stiffness,
                                                                  bristle_damping, level_end)));
  store_load(batch, at, applied, step.x, step.h, step.done);
  add_events(batch, at, events_where<P>(at.load(time.steps) > P(max_steps_to_stop), beyond_kernel));
}

/// One step of each moving lane with a bristle: to the next stop, to ω = 0, or as far as the series converge.
/// Reports beyond_kernel. See friction::Bristle.
///
/// `Fast` is for lanes whose level is that of Coulomb to the last bit: with Dahl's law, and far above the
/// Stribeck velocity, where (ω/ωs)² > 64. Their steps end where (ω/ωs)² = 42: exp(−42) = 6e-19. With a
/// second mass see slide_kernel.
template <class V, bool Fast>
void bristle_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  batch.event_count = 0;
  for_each_group<typename V::Wide>(lanes, [&](const auto& at) { bristle<Fast>(batch, at, forcing); });
}

}  // namespace zerocount::batch
