#pragma once

#include "core/batch/applied_torque.hpp"

namespace zerocount::batch {

/// The step of one vector; see slide_kernel.
template <bool Fast, bool Varies, class At>
__attribute__((noinline)) void slide(BatchState& batch, const At& at) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  MotionLanes& m = batch.motion;
  ContactLanes& c = batch.contact;
  TimeLanes& time = batch.time;
  const P zero(0.0);
  const P one(1.0);
  const P time_to_stop = at.load(time.time_to_stop);
  const P omega = at.load(m.omega);
  const P direction = at.load(m.slide_direction);
  const P coulomb = at.load(c.coulomb);
  const P breakaway_torque = at.load(c.breakaway);
  const P stribeck = direction * (breakaway_torque - coulomb);
  const P per_inertia = at.load(c.per_inertia);
  const P damping = at.load(c.sliding_damping);
  const P per_velocity_squared = at.load(c.per_velocity_squared);
  const P torque = at.load(m.torque);
  const P driving = torque - direction * coulomb;

  const P stribeck_velocity = one / sqrt(per_velocity_squared);
  const P speed = abs(omega);
  P stribeck_decay_start = zero;
  P h = time_to_stop;
  if constexpr (Fast) {
    const P above = speed - P(6.5) * stribeck_velocity;
    P resisting = breakaway_torque - direction * torque + damping * speed;
    if constexpr (Varies) {
      h = min(at.load(time.next_step), time_to_stop);
      resisting = resisting + torque_range(batch, at, h);
    }
    const P slowing = max(resisting, zero) * per_inertia;
    h = select(slowing * h > above, above / slowing, h);
  } else {
    stribeck_decay_start = exp(-per_velocity_squared * omega * omega);
    // (ω/ωs)² may change by about 4 per step, and by more far above the Stribeck velocity, where its
    // exponential is negligible.
    const P acceleration = abs(driving - stribeck * stribeck_decay_start - damping * omega) * per_inertia;
    const P changing = acceleration * (speed + P(2.0) * stribeck_velocity) * per_velocity_squared;
    const P far = per_velocity_squared * omega * omega;
    const P max_change = max(P(4.0), P(0.5) * (far - P(23.0)));
    h = min(min(at.load(time.next_step), max_change / changing), time_to_stop);
    h = select((h < time_to_stop) & (time_to_stop < P(1.4) * h), time_to_stop * P(0.5), h);
  }
  const P force_scale = h * h * per_inertia;
  const P damping_scale = damping * h * per_inertia;
  const P per_step_squared = per_velocity_squared / (h * h);

  P theta[batch_order + 1];
  P velocity[batch_order + 1];
  P exponent[batch_order + 1];
  P slope[batch_order + 1];
  P stribeck_decay[batch_order + 1];
  theta[0] = at.load(m.theta);
  velocity[0] = omega * h;
  [[maybe_unused]] VaryingTorque<P> applied;
  if constexpr (Varies) load_torque(batch, at, h, one, one, applied);
  stribeck_decay[0] = stribeck_decay_start;
#pragma GCC unroll 1
  for (int k = 0; k < batch_order; ++k) {
    P force = k == 0 ? driving : zero;
    if constexpr (Varies) {
      const P torque_k = applied.coefficient(k, velocity[k]);
      if (k > 0) force = torque_k;
    }
    if constexpr (!Fast) {
      exponent[k] = -per_step_squared * numerics::square_coefficient(velocity, k);
      if (k > 0) {
        slope[k - 1] = P(static_cast<double>(k)) * exponent[k];
        stribeck_decay[k] = numerics::exponential_coefficient(slope, stribeck_decay, k);
      }
      force = force - stribeck * stribeck_decay[k];
    }
    theta[k + 1] = velocity[k] * P(numerics::reciprocal.of[k + 1]);
    velocity[k + 1] = (force_scale * force - damping_scale * velocity[k]) * P(numerics::reciprocal.of[k + 1]);
  }

  const P left_out = (abs(theta[batch_order - 1]) + abs(velocity[batch_order - 1])) +
                     (abs(theta[batch_order]) + abs(velocity[batch_order]));
  const P allowed = at.load(time.tolerance) * (h * at.load(time.sample_rate));
  const Mask inexact = ~(left_out <= allowed);
  const P velocity_end = sum_of(velocity, batch_order);
  const Mask halts = velocity[0] * velocity_end < zero;
  Mask unfit = one < zero;
  if constexpr (!Fast) {
    P growth = max(exponent[batch_order - 1], zero);
#pragma GCC unroll 1
    for (int k = batch_order - 2; k >= 1; --k) growth = growth + max(exponent[k], zero);
    const Mask grows = growth > max(P(6.0), P(-23.0) - exponent[0]);
    const P curvature = curvature_bound(velocity, batch_order);
    unfit = grows | (~halts & ~cannot_turn(velocity[0], velocity_end, velocity[1], curvature));
    if constexpr (Varies) unfit = unfit | (halts & ~crosses_once(velocity, batch_order));
  }
  const Mask beyond = omega * direction <= zero;
  const Mask too_long = (inexact | unfit) & ~beyond;
  P x = one;
  const Mask seeks = at.taking_part() & halts & ~too_long;
  if (seeks.any())
    x = select(halts, root_between(velocity, batch_order, velocity[0], velocity_end, one, seeks), one);

  const Mask done = ~too_long & ~beyond;
  const Mask stops_here = ~halts & ~(h < time_to_stop);
  const P time_to_stop_then = select(stops_here, zero, time_to_stop - x * h);
  const P factor = P(0.9) * rough_power(allowed, left_out, 1.0 / batch_order);
  const P shorter = select(inexact, h * min(max(factor, P(0.05)), P(0.8)), h * P(0.5));
  const P longer = h * min(max(factor, P(0.3)), P(4.0));
  at.store(time.next_step, select(too_long, shorter, select(done, longer, h)));
  at.store(time.time_to_stop, select(done, time_to_stop_then, time_to_stop));
  at.store(time.steps, at.load(time.steps) + one);
  at.store(m.theta, select(done, value_of(theta, batch_order, x), theta[0]));
  at.store(m.omega, select(done, select(halts, zero, value_of(velocity, batch_order, x) / h), omega));
  add_events(batch, at,
             events_where<P>(done & halts, velocity_zero) +
                 events_where<P>(beyond | (at.load(time.steps) > P(max_steps_to_stop)), beyond_kernel));
}

/// One step of each lane whose hook slides: to the next stop, to ω = 0, or as far as the series converge.
/// Reports velocity_zero, and beyond_kernel where the slide starts at ω = 0. See PreslidingFriction::slide.
///
/// `Fast` is for lanes far above the Stribeck velocity, where (ω/ωs)² > 64 and friction is that of Coulomb to
/// the last bit. Their steps end where (ω/ωs)² = 42: exp(−42) = 6e-19.
template <class V, bool Fast, bool Varies>
void slide_kernel(BatchState& batch, const LaneSet& lanes) {
  batch.event_count = 0;
  for_each_vector<V>(lanes, [&](const auto& at) { slide<Fast, Varies>(batch, at); });
}

}  // namespace zerocount::batch
