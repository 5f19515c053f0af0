#pragma once

#include "core/batch/kernels/lane_group.hpp"

namespace zerocount::batch {

/// The samples of one vector of standing lanes; see stand_kernel.
template <class At>
__attribute__((noinline)) void stand(BatchState& batch, const At& at) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  const MotionLanes& m = batch.motion;
  const LoopLanes& l = batch.loop;
  MeasureLanes& q = batch.measures;
  TimeLanes& time = batch.time;
  const P zero(0.0);
  const P one(1.0);
  const Mask released = abs(at.load(m.torque)) > at.load(batch.contact.breakaway);
  const P within = at.load(m.hook) / at.load(l.resolution) + at.load(l.phase) - at.load(l.count);
  const Mask quiet = (within >= at.load(l.quiet_from)) & (within <= at.load(l.quiet_to));
  const P samples = at.load(time.samples_to_stop);
  const P passed = select(released | ~quiet, zero, samples - one);

  trial::ArrivalMeasures<P> arrival;
  trial::for_each_of_arrival(LoadEach<At>{at}, arrival, q);
  trial::measure_zeros(arrival, at.load(q.limits.dwell), passed);
  trial::for_each_of_arrival(StoreEach<At>{at}, q, arrival);
  at.store(time.samples_to_stop, select(released, samples, one));
  at.store(time.time_to_stop, select(released, at.load(time.time_to_stop), zero));
  add_events(batch, at, events_where<P>(released, breakaway));
}

/// Moves lanes that Coulomb's friction holds, and whose torque stays, to their next stop. Reports breakaway,
/// where the torque is beyond that of breakaway; such a lane stays where it is.
template <class V>
void stand_kernel(BatchState& batch, const LaneSet& lanes) {
  batch.event_count = 0;
  for_each_stretch<V>(lanes, [&](const auto& at) { stand(batch, at); });
}

}  // namespace zerocount::batch
