#pragma once

#include "core/batch/lane_group.hpp"
#include "core/loop/block_formulas.hpp"

namespace zerocount::batch {

/// Input of the control law at a sample.
template <class P>
struct ControlInput {
  using Mask = typename P::Mask;
  P error, last_error;  ///< counts
  P count, change;      ///< counts; change since the last sample, 0 at the first
  Mask counted;         ///< there has been a sample before
};

/// The control law with the conditions on its integral, PID or cascade by lane. @returns its torque, N m.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P law_torque(BatchState& batch, const At& at, const ControlInput<P>& in) {
  LoopLanes& l = batch.loop;
  BlockLanes& b = batch.blocks;
  const loop::IntegralConstants<P> rules{at.load(b.integral.enter),  at.load(b.integral.leave),
                                         at.load(b.integral.zone),   at.load(b.integral.retention),
                                         at.load(b.integral.lowest), at.load(b.integral.highest)};
  const loop::CascadeConstants<P> cascade{at.load(b.cascade.kv), at.load(b.cascade.velocity),
                                          at.load(b.cascade.kp), at.load(b.cascade.ki)};
  const typename P::Mask is_cascade = to_mask(at.load(b.is_cascade));
  const P d = loop::filtered_difference(at.load(b.pole), at.load(b.difference), in.change);
  const P w = loop::velocity_error(cascade, in.error, d);
  const P increment = select(is_cascade, cascade.ki * (w + at.load(b.last_velocity_error)),
                             at.load(l.ki) * (in.error + in.last_error));
  loop::IntegralState<P> state{at.load(l.integral), at.load(b.inside)};
  loop::integrate(rules, state, in.error, increment);
  at.store(l.integral, state.integral);
  at.store(b.inside, state.inside);
  at.store(b.difference, d);
  at.store(b.last_velocity_error, w);
  return select(is_cascade, loop::cascade_torque(state.integral, cascade.kp, w),
                loop::pid_torque(state.integral, at.load(l.kp), in.error, at.load(l.kd), d));
}

/// The torque after the filters, N m.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P filtered_torque(BatchState& batch, const At& at, P torque) {
  BlockLanes& b = batch.blocks;
  const P count = at.load(b.filter_count);
  for (int i = 0; i < max_lane_filters; ++i) {
    if (!(count > P(static_cast<double>(i))).any()) break;
    const loop::BiquadConstants<Lanes>& c = b.filters[i];
    loop::BiquadState<Lanes>& of = b.filter_states[i];
    const loop::BiquadConstants<P> constants{at.load(c.b0), at.load(c.b1), at.load(c.b2), at.load(c.a1),
                                             at.load(c.a2)};
    loop::BiquadState<P> state{at.load(of.s1), at.load(of.s2)};
    torque = loop::biquad_step(constants, state, torque);
    at.store(of.s1, state.s1);
    at.store(of.s2, state.s2);
  }
  return torque;
}

/// d̂ of the disturbance observer, N m.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P disturbance(BatchState& batch, const At& at, const ControlInput<P>& in) {
  BlockLanes& b = batch.blocks;
  const P first = select(in.counted, at.load(b.first_count), in.count);
  const loop::ObserverConstants<P> constants{at.load(b.observer.acceleration), at.load(b.observer.q),
                                             at.load(b.observer.a1), at.load(b.observer.a2)};
  loop::BiquadState<P> state{at.load(b.observer_state.s1), at.load(b.observer_state.s2)};
  const P estimate = loop::observer_step(constants, state, in.count - first, at.load(batch.loop.decided));
  at.store(b.first_count, first);
  at.store(b.observer_state.s1, state.s1);
  at.store(b.observer_state.s2, state.s2);
  return estimate;
}

/// The torque of the controller with its blocks (ControlChain), N m. A step has no feed-forward.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P block_torque(BatchState& batch, const At& at, const ControlInput<P>& in) {
  const P torque = filtered_torque(batch, at, law_torque(batch, at, in));
  const typename P::Mask observes = to_mask(at.load(batch.blocks.observes));
  if (!observes.any()) return torque;
  return select(observes, torque - disturbance(batch, at, in), torque);
}

}  // namespace zerocount::batch
