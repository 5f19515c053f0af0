#pragma once

#include "core/batch/kernels/lane_group.hpp"
#include "core/batch/kernels/velocity_step.hpp"

namespace zerocount::batch {

/// Passes the samples of one vector of lanes whose rotor stands still; see stand_kernel().
template <class At>
__attribute__((noinline)) void stand(BatchState& batch, const At& at) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  const MotionLanes& m = batch.motion;
  const LoopLanes& l = batch.loop;
  TimeLanes& time = batch.time;
  const P zero(0.0);
  const P one(1.0);
  const Mask released = abs(at.load(m.torque)) > at.load(batch.contact.breakaway);
  const P within = at.load(m.hook) / at.load(l.resolution) + at.load(l.phase) - at.load(l.count);
  const Mask quiet = (within >= at.load(l.quiet_from)) & (within <= at.load(l.quiet_to));
  const P samples = at.load(time.samples_to_stop);
  const P passed = select(released | ~quiet, zero, samples - one);

  measure_passed(batch, at, passed);
  at.store(time.samples_to_stop, select(released, samples, one));
  at.store(time.time_to_stop, select(released, at.load(time.time_to_stop), zero));
  add_events(batch, at, events_where<P>(released, breakaway));
}

/// Moves lanes whose rotor Coulomb friction holds still under a constant torque to their next stop, at which
/// the torque may change. Reports breakaway if the torque exceeds the breakaway torque; such a lane is not
/// moved.
template <class V>
void stand_kernel(BatchState& batch, const LaneSet& lanes) {
  batch.event_count = 0;
  for_each_stretch<V>(lanes, [&](const auto& at) { stand(batch, at); });
}

/// One step of one vector of lanes whose rotor stands still under a varying torque or a second mass; see
/// stand_forced_kernel().
template <class At>
__attribute__((noinline)) void stand_forced(BatchState& batch, const At& at, Forcing forcing) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  TimeLanes& time = batch.time;
  const P zero(0.0);
  const P one(1.0);
  const P time_to_stop = at.load(time.time_to_stop);
  P h = time_to_stop;
  if (forcing.loaded) h = without_short_remainder(min(at.load(time.next_step), h), time_to_stop);
  ForcedTorque<P> applied;
  load_torque(batch, at, forcing, h, one, one, applied);
  P bound = abs(torque_on_rotor(batch, at, forcing, zero));
  applied.coefficient(0, zero);
  for (int k = 1; k < batch_order; ++k) {
    const P coefficient = abs(applied.coefficient(k, zero));
    // The last two count twice: for the terms of a lag and of a load beyond them.
    bound = bound + (k < batch_order - 2 ? coefficient : P(2.0) * coefficient);
  }
  // Lines may cancel in any orders, but not in this bound.
  if (forcing.varies) bound = bound + at.load(batch.course.left_out);
  ContactLanes& c = batch.contact;
  Mask held = bound < P(1.0 - 1e-12) * at.load(c.breakaway);
  at.store(c.spent, select(held, zero, at.load(c.spent)));
  if (forcing.loaded) {
    VelocityStep<P> step = velocity_step(batch, at, time_to_stop, h, last_terms_of_load(applied));
    step.too_long = step.inexact;
    step.halts = zero < zero;
    step.done = held & ~step.too_long;
    store_time(batch, at, step);
    store_load(batch, at, applied, step.x, h, step.done);
    held = held | step.too_long;
  } else {
    at.store(time.time_to_stop, select(held, zero, time_to_stop));
    at.store(time.steps, at.load(time.steps) + one);
  }
  held = held & ~(at.load(time.steps) > P(max_steps_to_stop));
  add_events(batch, at, events_where<P>(~held, breakaway));
}

/// One step, at most to the next sample, of lanes whose rotor Coulomb friction holds still while a varying
/// torque or a second mass acts on it. Reports breakaway if a bound of the torque exceeds the breakaway
/// torque; such a lane is not moved.
template <class V>
void stand_forced_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  batch.event_count = 0;
  for_each_group<typename V::Wide>(lanes, [&](const auto& at) { stand_forced(batch, at, forcing); });
}

}  // namespace zerocount::batch
