#pragma once

#include "core/batch/kernels/lane_group.hpp"
#include "core/loop/controller/block_formulas.hpp"

namespace zerocount::batch {

/// Input of the control law at a sampling instant.
template <class P>
struct ControlInput {
  using Mask = typename P::Mask;
  P error, last_error;  ///< Error (target − count) at this sample and at the last sample, counts
  P count, change;  ///< Count of the encoder at this sample, and its change since the last sample, counts. At
                    /// < the first sample CountsBefore gives the change.
  Mask counted;     ///< Mask of the lanes that have had a sample before this one
};

/// Result of the controller blocks that act before the control law: dead zone, standstill and torque hold.
template <class P>
struct Compensated {
  using Mask = typename P::Mask;
  P acting_error;  ///< Error e′ after the dead zone, counts
  Mask stands;     ///< Mask of the lanes in which the standstill gains replace the PID gains
  Mask held;       ///< Mask of the lanes in which the torque is held, so that the controller's states stay as
                   /// < they are
};

/// Stores a new value in `lanes`, except in the lanes of `held`, whose torque is held.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void store_unless(const typename P::Mask& held, const At& at, Lanes& lanes,
                                          const P& value) {
  at.store(lanes, select(held, at.load(lanes), value));
}

/// Applies the dead zone to the error, and updates whether the standstill gains act and whether the torque is
/// held.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE Compensated<P> compensated(BatchState& batch, const At& at,
                                                   const ControlInput<P>& in) {
  using Mask = typename P::Mask;
  BlockLanes& b = batch.blocks;
  const P zero(0.0);
  const P one(1.0);
  const P target = at.load(batch.loop.target);
  const Mask changed = target != at.load(b.last_target);
  const P new_target = select(in.counted & changed, one, zero);
  const P fresh = select(in.counted, new_target, one);
  at.store(b.last_target, target);

  P run = at.load(b.standstill_run);
  const Mask stands = loop::stands_still(load_struct(at, b.standstill), run, new_target, in.error);
  at.store(b.standstill_run, run);

  loop::HoldState<P> state{at.load(b.hold_state.run), at.load(b.hold_state.holding), zero};
  const Mask held = loop::holds_torque(load_struct(at, b.hold), state, fresh, in.error);
  at.store(b.hold_state.run, state.run);
  at.store(b.hold_state.holding, state.holding);

  return {loop::acting_error(load_struct(at, b.deadband), in.error), stands, held};
}

/// Torque of the control law, PID or cascade depending on the lane, N m. Updates its integral under the
/// conditions of deadband, zone, leak and range.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P law_torque(BatchState& batch, const At& at, const ControlInput<P>& in,
                                     const Compensated<P>& now) {
  LoopLanes& l = batch.loop;
  BlockLanes& b = batch.blocks;
  const loop::CascadeConstants<P> cascade = load_struct(at, b.cascade);
  const P kp = select(now.stands, at.load(b.standstill.kp), at.load(l.kp));
  const P ki = select(now.stands, at.load(b.standstill.ki), at.load(l.ki));
  const P kd = select(now.stands, at.load(b.standstill.kd), at.load(l.kd));
  const typename P::Mask is_cascade = to_mask(at.load(b.is_cascade));
  const P last_d = at.load(b.difference);
  const P d = select(now.held, last_d, loop::filtered_difference(at.load(b.pole), last_d, in.change));
  const P w = loop::velocity_error(cascade, cascade.kv * now.acting_error, d);
  const P increment = select(is_cascade, cascade.ki * (w + at.load(b.last_velocity_error)),
                             ki * (now.acting_error + at.load(b.last_acting_error)));
  loop::IntegralState<P> state{at.load(l.integral), at.load(b.inside)};
  loop::integrate(load_struct(at, b.integral), state, in.error, increment);
  store_unless(now.held, at, l.integral, state.integral);
  store_unless(now.held, at, b.inside, state.inside);
  at.store(b.difference, d);
  at.store(b.last_velocity_error, w);
  at.store(b.last_acting_error, now.acting_error);
  return select(is_cascade, loop::cascade_torque(state.integral, cascade.kp, w),
                loop::pid_torque(state.integral, kp, now.acting_error, kd, d));
}

/// Torque after the controller's filters (biquads in series), N m. The filters' states stay in lanes whose
/// torque is held.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P filtered_torque(BatchState& batch, const At& at, P torque,
                                          const typename P::Mask& held) {
  BlockLanes& b = batch.blocks;
  const P count = at.load(b.filter_count);
  for (int i = 0; i < max_lane_filters; ++i) {
    if (!(count > P(static_cast<double>(i))).any()) break;
    loop::BiquadState<Lanes>& of = b.filter_states[i];
    loop::BiquadState<P> state = load_struct(at, of);
    torque = loop::biquad_step(load_struct(at, b.filters[i]), state, torque);
    store_unless(held, at, of.s1, state.s1);
    store_unless(held, at, of.s2, state.s2);
  }
  return torque;
}

/// Estimate d̂ of the disturbance observer, N m.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P disturbance(BatchState& batch, const At& at, const ControlInput<P>& in,
                                      const typename P::Mask& held) {
  BlockLanes& b = batch.blocks;
  const P first = select(in.counted, at.load(b.first_count), in.count);
  loop::BiquadState<P> state = load_struct(at, b.observer_state);
  const P estimate =
      loop::observer_step(load_struct(at, b.observer), state, in.count - first, at.load(batch.loop.decided));
  at.store(b.first_count, first);
  store_unless(held, at, b.observer_state.s1, state.s1);
  store_unless(held, at, b.observer_state.s2, state.s2);
  return estimate;
}

/// Wanted torque of the controller with all its blocks (ControlChain), plus its dither and the rounding error
/// that a sigma-delta converter carries over, N m. Feed-forward is absent, because these lanes have step
/// references only.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P block_torque(BatchState& batch, const At& at, const ControlInput<P>& in) {
  BlockLanes& b = batch.blocks;
  const Compensated<P> now = compensated(batch, at, in);
  P torque = filtered_torque(batch, at, law_torque(batch, at, in, now), now.held);
  const typename P::Mask observes = to_mask(at.load(b.observes));
  if (observes.any()) torque = select(observes, torque - disturbance(batch, at, in, now.held), torque);
  torque = select(now.held, at.load(b.hold_state.torque), torque);
  at.store(b.hold_state.torque, torque);
  const P k = at.load(b.sample);
  at.store(b.sample, k + P(1.0));
  const P dither = loop::dither_torque(at.load(b.dither_amplitude), at.load(b.dither_frequency),
                                       at.load(batch.time.sample_rate), k);
  return torque + dither + at.load(b.remainder);
}

/// Mask of the lanes whose torque may change while the error stays 0, because a memory fades or a dwell ends.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask has_memory(const BatchState& batch, const At& at) {
  const BlockLanes& b = batch.blocks;
  const P zero(0.0);
  const auto hold_to_come =
      (at.load(b.hold.enter) >= zero) & (at.load(b.hold_state.run) < at.load(b.hold.dwell));
  const auto standstill_to_come =
      (at.load(b.standstill.band) >= zero) & (at.load(b.standstill_run) <= at.load(b.standstill.dwell));
  return to_mask(at.load(b.remembers)) | hold_to_come | standstill_to_come;
}

/// Stores the rounding error of this sample in the lanes with a sigma-delta converter; it is added to the
/// next torque.
/// @param torque wanted torque, N m.
/// @param converted torque of the rounded code, N m.
/// @param clipped lanes whose code was out of range.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void keep_remainder(BatchState& batch, const At& at, const P& torque,
                                            const P& converted, const typename P::Mask& clipped) {
  const P remainder = loop::rounding_remainder(torque, converted, clipped);
  at.store(batch.blocks.remainder, select(to_mask(at.load(batch.blocks.sigma_delta)), remainder, P(0.0)));
}

}  // namespace zerocount::batch
