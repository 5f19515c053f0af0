#pragma once

#include "core/batch/applied_torque.hpp"
#include "core/friction/bristle_formulas.hpp"

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
LaneSet bristle_rest_kernel(BatchState& batch, const LaneSet& lanes) {
  MotionLanes& m = batch.motion;
  LaneSet moving = lanes;
  for (int base = 0; base < max_lanes; base += P::lanes) {
    const unsigned here = lanes.stretch(base, P::lanes);
    if (here == 0) continue;
    const typename P::Mask rests = rests_on_bristle<P>(batch, LaneStretch<P>(base, here));
    const unsigned resting = rests.bits() & here;
    if (resting == 0) continue;
    moving.erase_stretch(base, resting);
    const LaneStretch<P> at(base, resting);
    at.store(m.elongation, at.load(m.torque) / at.load(batch.contact.bristle_stiffness));
    at.store(m.omega, P(0.0));
    at.store(m.gradual_slide, P(0.0));
    at.store(batch.time.time_to_stop, P(0.0));
  }
  return moving;
}

/// The step of one vector; see bristle_kernel.
template <bool Fast, bool Varies, class At>
__attribute__((noinline)) void bristle(BatchState& batch, const At& at) {
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
  const P torque = at.load(m.torque);
  const P stiffness = at.load(c.bristle_stiffness);
  const P bristle_damping = at.load(c.bristle_damping);
  const P damping = at.load(c.sliding_damping);
  const P coulomb = at.load(c.coulomb);
  const P excess = at.load(c.breakaway) - coulomb;
  const P per_inertia = at.load(c.per_inertia);
  const P per_velocity_squared = at.load(c.per_velocity_squared);

  const Mask from_zero = omega == zero;
  P direction = sign(select(from_zero, torque - stiffness * deflection_start, omega));
  if constexpr (Varies) {
    direction = select(direction == zero, sign(torque_rate(batch, at, omega)), direction);
  }
  const P speed = abs(omega);
  const P stribeck_velocity = one / sqrt(per_velocity_squared);
  P stribeck_decay_start = zero;
  P h = min(at.load(time.next_step), time_to_stop);
  if constexpr (Fast) {
    const P above = speed - P(6.5) * stribeck_velocity;
    P max_torque = max(stiffness * abs(deflection_start), coulomb + excess) + abs(torque);
    if constexpr (Varies) max_torque = max_torque + torque_range(batch, at, h);
    const P slowing = (max_torque + (damping + P(2.0) * bristle_damping) * speed) * per_inertia;
    h = select((excess > zero) & (slowing * h > above), above / slowing, h);
  } else {
    stribeck_decay_start = exp(-per_velocity_squared * omega * omega);
    const P rate =
        omega - direction * stiffness * omega * deflection_start / (coulomb + excess * stribeck_decay_start);
    const P unbalanced = torque - stiffness * deflection_start - bristle_damping * rate - damping * omega;
    // (ω/ωs)² may change by about 4 per step, and far above the Stribeck velocity by more.
    const P changing =
        abs(unbalanced) * per_inertia * (speed + P(2.0) * stribeck_velocity) * per_velocity_squared;
    const P far = per_velocity_squared * omega * omega;
    h = min(h, max(P(4.0), P(0.5) * (far - P(23.0))) / changing);
  }
  h = select((h < time_to_stop) & (time_to_stop < P(1.4) * h), time_to_stop * P(0.5), h);
  const P force_scale = h * h * per_inertia;
  const P damping_scale = h * per_inertia;
  const P per_step_squared = per_velocity_squared / (h * h);
  const P end_of_bristle = direction * coulomb / stiffness;
  const Mask saturated =
      friction::is_at_end(deflection_start, end_of_bristle, coulomb, at.load(c.inertia), omega);
  const P towards = direction * stiffness;
  const P per_coulomb = one / coulomb;

  P travel[batch_order + 1];
  P velocity[batch_order + 1];
  P deflection[batch_order + 1];  // z
  P ratio[batch_order + 1];       // ω·z/g
  P exponent[batch_order + 1];
  P slope[batch_order + 1];
  P stribeck_decay[batch_order + 1];
  P level[batch_order + 1];
  travel[0] = zero;
  velocity[0] = omega * h;
  deflection[0] = Fast ? select(saturated, end_of_bristle, deflection_start) : deflection_start;
  stribeck_decay[0] = stribeck_decay_start;
  [[maybe_unused]] VaryingTorque<P> applied;
  if constexpr (Varies) load_torque(batch, at, h, one, one, applied);
#pragma GCC unroll 1
  for (int k = 0; k < batch_order; ++k) {
    P product = velocity[0] * deflection[k];
#pragma GCC unroll 1
    for (int j = 1; j <= k; ++j) product = product + velocity[j] * deflection[k - j];
    if constexpr (Fast) {
      ratio[k] = product * per_coulomb;
    } else {
      exponent[k] = -per_step_squared * numerics::square_coefficient(velocity, k);
      if (k > 0) {
        slope[k - 1] = P(static_cast<double>(k)) * exponent[k];
        stribeck_decay[k] = numerics::exponential_coefficient(slope, stribeck_decay, k);
      }
      level[k] = excess * stribeck_decay[k] + (k == 0 ? coulomb : zero);
      ratio[k] = numerics::quotient_coefficient(product, level, ratio, k);
    }
    P rate = velocity[k] - towards * ratio[k];
    if constexpr (Fast) rate = select(saturated, zero, rate);
    const P per_order = P(numerics::reciprocal.of[k + 1]);
    P torque_k = k == 0 ? torque : zero;
    if constexpr (Varies) torque_k = applied.coefficient(k, velocity[k]);
    const P force = torque_k - stiffness * deflection[k];
    travel[k + 1] = velocity[k] * per_order;
    deflection[k + 1] = rate * per_order;
    velocity[k + 1] =
        (force_scale * force - damping_scale * (bristle_damping * rate + damping * velocity[k])) * per_order;
  }

  const P left_out = ((abs(travel[batch_order - 1]) + abs(velocity[batch_order - 1])) +
                      (abs(travel[batch_order]) + abs(velocity[batch_order]))) +
                     (abs(deflection[batch_order - 1]) + abs(deflection[batch_order]));
  const P allowed = at.load(time.tolerance) * (h * at.load(time.sample_rate));
  const Mask inexact = ~(left_out <= allowed);
  const P velocity_start = select(from_zero, velocity[1], velocity[0]);
  const P velocity_end = sum_of(velocity, batch_order);
  const Mask halts = velocity_start * velocity_end < zero;
  // Neither ω, nor ω/t where ω starts at 0, may have two zeros within the step.
  P signed_part[batch_order + 1];
  for (int k = 0; k < batch_order; ++k) signed_part[k] = select(from_zero, velocity[k + 1], velocity[k]);
  signed_part[batch_order] = select(from_zero, zero, velocity[batch_order]);
  Mask unfit = ~halts & ~cannot_turn(signed_part[0], velocity_end, signed_part[1],
                                     curvature_bound(signed_part, batch_order));
  if constexpr (Varies) {
    unfit = unfit | (halts & ~crosses_once(signed_part, batch_order));
    // A rotor that nothing moves keeps still.
    unfit = unfit & ((curvature_bound(signed_part, batch_order) > zero) | (signed_part[1] != zero));
  }
  if constexpr (!Fast) {
    P growth = max(exponent[batch_order - 1], zero);
#pragma GCC unroll 1
    for (int k = batch_order - 2; k >= 1; --k) growth = growth + max(exponent[k], zero);
    unfit = unfit | (growth > max(P(6.0), P(-23.0) - exponent[0]));
  }
  const Mask too_long = inexact | unfit;
  P x = one;
  const Mask seeks = at.taking_part() & halts & ~too_long;
  if (seeks.any()) {
    x = select(halts, next_zero(velocity, batch_order, velocity_start, velocity_end, from_zero, seeks), one);
  }

  const Mask moves = ~too_long;
  const P omega_end = select(moves, select(halts, zero, value_of(velocity, batch_order, x) / h), omega);
  const P deflection_end = select(moves, value_of(deflection, batch_order, x), deflection_start);
  const Mask stops_here = moves & ~halts & ~(h < time_to_stop);
  const P level_end = Fast ? coulomb : coulomb + excess * exp(-per_velocity_squared * omega_end * omega_end);
  const P rate_end = omega_end - stiffness * abs(omega_end) * deflection_end / level_end;
  const Mask slides = abs(stiffness * deflection_end + bristle_damping * rate_end) > P(0.99) * level_end;
  const P factor = P(0.9) * rough_power(allowed, left_out, 1.0 / batch_order);
  const P shorter = select(inexact, h * min(max(factor, P(0.05)), P(0.8)), h * P(0.5));
  const P longer = h * min(max(factor, P(0.3)), P(4.0));
  at.store(time.next_step, select(too_long, shorter, select(moves, longer, at.load(time.next_step))));
  at.store(time.time_to_stop, select(stops_here, zero, select(moves, time_to_stop - x * h, time_to_stop)));
  at.store(time.steps, at.load(time.steps) + one);
  at.store(m.theta, at.load(m.theta) + select(moves, value_of(travel, batch_order, x), zero));
  at.store(m.omega, omega_end);
  at.store(m.elongation, deflection_end);
  at.store(m.gradual_slide, to_number<P>(slides));
  add_events(batch, at, events_where<P>(at.load(time.steps) > P(max_steps_to_stop), beyond_kernel));
}

/// One step of each moving lane with a bristle: to the next stop, to ω = 0, or as far as the series converge.
/// Reports beyond_kernel. See friction::Bristle.
///
/// `Fast` is for lanes whose level is that of Coulomb to the last bit: with Dahl's law, and far above the
/// Stribeck velocity, where (ω/ωs)² > 64. Their steps end where (ω/ωs)² = 42: exp(−42) = 6e-19.
template <class V, bool Fast, bool Varies>
void bristle_kernel(BatchState& batch, const LaneSet& lanes) {
  batch.event_count = 0;
  for_each_vector<V>(lanes, [&](const auto& at) { bristle<Fast, Varies>(batch, at); });
}

}  // namespace zerocount::batch
