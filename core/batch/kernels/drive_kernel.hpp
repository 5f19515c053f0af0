#pragma once

#include "core/batch/kernels/lane_group.hpp"
#include "core/batch/kernels/noise.hpp"

namespace zerocount::batch {

/// Duration (s) of the next piece of constant amplifier input in lanes with late samples: T + δ_{k+1} − δ_k,
/// with δ_k the lateness of sample k.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P late_duration(BatchState& batch, const At& at, const P& jitter) {
  DriveLanes& d = batch.drive;
  const P next = at.load(d.sample) + P(1.0);
  P uniform;
  set_uniform_at(d.random, at, next, uniform);
  const P late = jitter * uniform;
  const P duration = (at.load(batch.time.sample_time) + late) - at.load(d.late);
  at.store(d.sample, next);
  at.store(d.late, late);
  return duration;
}

/// Passes the converter's torque of one vector of lanes through delay and amplifier, as drive_kernel() does.
/// @returns mask of the lanes whose torque varies until the next stop.
template <class At>
__attribute__((noinline)) typename At::Vector::Mask drive(BatchState& batch, const At& at) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  DriveLanes& d = batch.drive;
  CourseLanes& c = batch.course;
  TimeLanes& time = batch.time;
  const P zero(0.0);
  const P one(1.0);
  const P input = at.load(batch.loop.converted);
  const P delay = at.load(d.delay);
  P leaving = input;
  P waiting = input;
  for (int i = 0; i < max_lane_delay; ++i) {
    const P older = at.load(d.waiting[i]);
    at.store(d.waiting[i], waiting);
    leaving = select(delay == P(i + 1.0), older, leaving);
    waiting = older;
  }
  const P alike = select(input == at.load(d.last), at.load(d.alike) + one, one);
  at.store(d.last, input);
  const P rate = at.load(d.rate);
  // loop::Drive: a lag too small for a normal number counts as 0.
  const P last_settled = at.load(d.settled);
  P lag = (at.load(d.now) - last_settled) * at.load(d.decay);
  lag = select(abs(lag) < P(0x1p-1022), zero, lag);
  const P now = select(rate == zero, leaving, last_settled + lag);
  const Mask varies = (now != leaving) | to_mask(at.load(d.disturbed));
  const P jitter = at.load(d.jitter);
  const Mask is_late = (jitter > zero) & at.taking_part();
  const P late_before = at.load(d.late);
  P duration = at.load(time.sample_time);
  if (is_late.any()) {
    duration = select(is_late, late_duration(batch, at, jitter), duration);
    at.store(d.decay, select(is_late, exp(-rate * duration), at.load(d.decay)));
  }
  const Mask stays = (now == leaving) & (alike > delay) & ~is_late & ~to_mask(at.load(d.stops));
  at.store(d.alike, alike);
  at.store(d.now, now);
  at.store(d.settled, leaving);

  const P disturbance = at.load(batch.loop.disturbance);
  at.store(batch.motion.torque, now + disturbance);
  at.store(c.settled, leaving + disturbance);
  at.store(c.lag, now - leaving);
  at.store(c.decay, select(stays, zero, rate));
  at.store(c.piece, duration);
  at.store(c.piece_end, late_before + duration);
  at.store(time.samples_to_stop, select(stays, at.load(time.samples_to_stop), one));
  at.store(time.time_to_stop, select(stays, at.load(time.time_to_stop), duration));
  return varies & at.taking_part();
}

/// Passes the torques of the converter at a sample through a delay of whole samples and through the
/// amplifier, as loop::Drive does. The next stop of a lane whose motor's torque may change is the next
/// sample, which may be late.
/// @returns the lanes whose torque varies until then.
template <class V>
LaneSet drive_kernel(BatchState& batch, const LaneSet& lanes) {
  LaneSet varying;
  for_each_stretch<V>(lanes,
                      [&](const auto& at) { varying.insert_stretch(at.lane(0), drive(batch, at).bits()); });
  return varying;
}

}  // namespace zerocount::batch
