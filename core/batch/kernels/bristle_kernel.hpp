#pragma once

#include "core/batch/kernels/velocity_step.hpp"
#include "core/friction/bristles/bristle_formulas.hpp"

namespace zerocount::batch {

template <class At, class P = typename At::Vector>
ZEROCOUNT_ALWAYS_INLINE friction::BristleConstants<P> bristle_of(const BatchState& batch, const At& at) {
  const ContactLanes& c = batch.contact;
  const P coulomb = at.load(c.coulomb);
  return {at.load(c.bristle_stiffness),
          at.load(c.bristle_damping),
          at.load(c.sliding_damping),
          {coulomb, at.load(c.breakaway) - coulomb, at.load(c.per_velocity_squared)}};
}

/// Mask of the lanes whose rotor is at rest on its bristle under the present torque.
template <class At, class P = typename At::Vector>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask rests_on_bristle(const BatchState& batch, const At& at) {
  const friction::BristleConstants<P> of = bristle_of(batch, at);
  const P omega = at.load(batch.motion.omega);
  const P torque = at.load(batch.motion.torque);
  const P deflection = at.load(batch.motion.elongation);
  const auto balanced = (omega == P(0.0)) & (deflection == torque / of.stiffness);
  return balanced | friction::bristle_rests(of, deflection, omega, torque, at.load(batch.contact.inertia),
                                            at.load(batch.time.rest));
}

/// Moves the lanes whose rotor is at rest on its bristle to their next stop, the next instant at which their
/// torque may change.
/// @returns the lanes that are not at rest.
template <class P>
LaneSet bristle_rest_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  MotionLanes& m = batch.motion;
  LaneSet moving = lanes;
  for (int base = 0; base < max_lanes; base += P::lanes) {
    const unsigned here = lanes.stretch(base, P::lanes);
    if (here == 0) continue;
    const LaneStretch<P> all(base, here);
    typename P::Mask rests = rests_on_bristle(batch, all);
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

/// Integrates one step of one vector of lanes with a bristle; see bristle_kernel().
template <bool Fast, class At>
__attribute__((noinline)) void bristle(BatchState& batch, const At& at, Forcing forcing) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  MotionLanes& m = batch.motion;
  const P zero(0.0);
  const P one(1.0);
  const P time_to_stop = at.load(batch.time.time_to_stop);
  const P omega = at.load(m.omega);
  const P deflection = at.load(m.elongation);
  const P torque = torque_on_rotor(batch, at, forcing, omega);
  const P per_inertia = at.load(batch.contact.per_inertia);
  const friction::BristleConstants<P> of = bristle_of(batch, at);
  const auto& [coulomb, excess, per_velocity_squared] = of.level;
  const P unbalanced = torque - of.stiffness * deflection;
  const P direction = heading_under(batch, at, forcing, omega, unbalanced);
  const P speed = abs(omega);
  const P stribeck_velocity = one / sqrt(per_velocity_squared);
  P decay_start = zero;
  P h = min(at.load(batch.time.next_step), time_to_stop);
  if constexpr (Fast) {
    P max_torque = max(of.stiffness * abs(deflection), coulomb + excess) + abs(torque);
    if (forcing.varies) max_torque = max_torque + torque_range(batch, at, h);
    const P slowing = (max_torque + (of.damping + P(2.0) * of.bristle_damping) * speed) * per_inertia;
    h = select(excess > zero, fast_step(speed, stribeck_velocity, slowing, h), h);
  } else {
    decay_start = exp(-per_velocity_squared * omega * omega);
    const P rate = omega - direction * of.stiffness * omega * deflection / (coulomb + excess * decay_start);
    const P accelerating = unbalanced - of.bristle_damping * rate - of.damping * omega;
    h = min(h,
            stribeck_step(omega, abs(accelerating) * per_inertia, stribeck_velocity, per_velocity_squared));
  }
  h = without_short_remainder(h, time_to_stop);

  const P end = direction * coulomb / of.stiffness;
  const Mask saturated = friction::is_at_end(deflection, end, coulomb, at.load(batch.contact.inertia), omega);
  friction::BristleSeriesOf<P[batch_order + 1]> s;
  s.position[0] = zero;
  s.omega[0] = omega * h;
  s.deflection[0] = Fast ? select(saturated, end, deflection) : deflection;
  s.decay[0] = decay_start;
  ForcedTorque<P> applied;
  load_torque(batch, at, forcing, h, one, one, applied);
  const friction::BristleConstants<P> law = in_unit_of_time(of, h);
  expand_motion(
      s, applied, h, torque, per_inertia, [&](std::size_t k, const P& u) __attribute__((always_inline)) {
        return friction::bristle_coefficient<Fast>(law, direction, saturated, s, k, u);
      });

  VelocityStep<P> step =
      velocity_step(batch, at, time_to_stop, h, last_terms_of(s, applied) + last_terms_of(s.deflection));
  Mask unfit = halts_unsurely(s.omega, forcing.any(), step);
  if constexpr (!Fast) unfit = unfit | grows_too_much(s.exponent);
  if (Fast && forcing.loaded) unfit = unfit | ((excess > zero) & ~stays_fast(s.omega, stribeck_velocity, h));
  step.too_long = step.inexact | unfit;
  step.done = ~step.too_long;
  end_at_halt(s.omega, at, step);
  store_motion(batch, at, s, applied, omega, step);

  const P omega_end = at.load(m.omega);
  const P deflection_end = select(step.done, value_of(s.deflection, batch_order, step.x), deflection);
  const P level_end = Fast ? coulomb : coulomb + excess * exp(-per_velocity_squared * omega_end * omega_end);
  at.store(m.elongation, deflection_end);
  at.store(m.gradual_slide, to_number<P>(friction::bristle_slides(of, deflection_end, omega_end, level_end)));
  add_events(batch, at, lost_in_steps<P>(batch, at));
}

/// One integration step of each moving lane with a bristle. The step ends at the lane's next stop (at which
/// its torque may change), at ω = 0, or where the Taylor series cease to be accurate. Reports beyond_kernel
/// for lanes that it cannot compute. See friction::Bristle.
///
/// `Fast` is for lanes whose friction level equals the Coulomb level to the last bit: lanes with Dahl's law,
/// and lanes far above the Stribeck velocity, with (ω/ωs)² > 64. Their steps end where (ω/ωs)² = 42, because
/// exp(−42) = 6e-19. For lanes with a second mass see slide_kernel().
template <class V, bool Fast>
void bristle_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  batch.event_count = 0;
  for_each_group<typename V::Wide>(lanes, [&](const auto& at) { bristle<Fast>(batch, at, forcing); });
}

}  // namespace zerocount::batch
