#pragma once

#include "core/batch/kernels/lane_group.hpp"
#include "core/batch/kernels/trigonometry.hpp"

namespace zerocount::batch {

/// Goes on at rest to the next stop of one vector. @returns the lanes that do; see creep_ahead_kernel.
template <class At>
__attribute__((noinline)) typename At::Vector::Mask creep_ahead(BatchState& batch, const At& at) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  MotionLanes& m = batch.motion;
  TimeLanes& time = batch.time;
  CreepAheadLanes& a = batch.ahead;
  const P zero(0.0);
  const P elapsed = at.load(a.elapsed) + at.load(time.time_to_stop);
  const P duration = at.load(a.duration);
  const P torque = at.load(m.torque);
  const Mask goes_on = at.taking_part() & (elapsed <= duration) & (torque == at.load(m.rest_torque)) &
                       (at.load(time.samples_to_stop) == P(1.0));
  if (!goes_on.any()) return goes_on;

  const P x = elapsed / duration;
  const auto value_of = [&](Lanes(&c)[4]) {
    return at.load(c[0]) + x * (at.load(c[1]) + x * (at.load(c[2]) + x * at.load(c[3])));
  };
  P elongation = value_of(a.elongation);
  P extension = value_of(a.extension);
  P hardening = value_of(a.hardening);
  const P t = at.load(a.start) + elapsed;
  const Mask oscillates = t < at.load(a.oscillation_end);
  if ((oscillates & goes_on).any()) {
    const friction::OscillationConstants<P> of = load_struct(at, a.oscillation);
    const friction::OscillationPhase<P> now = friction::oscillation_phase(of, P(1.0) - exp(-of.decay * t), t);
    P sine, cosine;
    sine_and_cosine(now.phase, sine, cosine);
    const friction::OscillationState<P> state = friction::oscillation_state(of, now.amplitude, sine, cosine);
    elongation = elongation + select(oscillates, state.elongation, zero);
    extension = extension + select(oscillates, state.extension, zero);
    hardening = hardening + select(oscillates, at.load(a.creep_sign) * state.extension, zero);
  }
  const auto store = [&](Lanes& to, const P& value) { at.store(to, select(goes_on, value, at.load(to))); };
  store(a.elapsed, elapsed);
  store(m.elongation, elongation);
  store(m.extension, extension);
  store(m.hardening, hardening);
  store(time.time_to_stop, zero);
  return goes_on;
}

/// Moves lanes at rest to their next stop, by the description of their motion (CreepAheadLanes), as long as
/// their torque stays and the description lasts. @returns the lanes that it has moved.
template <class V>
LaneSet creep_ahead_kernel(BatchState& batch, const LaneSet& lanes) {
  LaneSet moved;
  for_each_stretch<V>(
      lanes, [&](const auto& at) { moved.insert_stretch(at.lane(0), creep_ahead(batch, at).bits()); });
  return moved;
}

}  // namespace zerocount::batch
