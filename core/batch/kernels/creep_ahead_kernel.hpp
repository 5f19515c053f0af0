#pragma once

#include "core/batch/kernels/lane_group.hpp"
#include "core/batch/kernels/series.hpp"

namespace zerocount::batch {

/// State of the contact of a lane at rest, evaluated from the polynomial description of its slow motion
/// (CreepAheadLanes).
template <class P>
struct MotionAhead {
  P elongation;  ///< Elongation xs of the contact's spring, rad
  P extension;   ///< Plastic extension xp by creep, rad
  P hardening;   ///< Hardening xh by creep, rad
};

/// Evaluates the polynomial description of the motion at rest at the time `elapsed` (s) after its start, in
/// the lanes of `wanted`.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE MotionAhead<P> motion_ahead(const BatchState& batch, const At& at, const P& elapsed,
                                                    const typename P::Mask& wanted) {
  using Mask = typename P::Mask;
  const CreepAheadLanes& a = batch.ahead;
  const P zero(0.0);
  const P x = elapsed / at.load(a.duration);
  const auto value_of = [&](const Lanes(&c)[4]) __attribute__((always_inline)) {
    return at.load(c[0]) + x * (at.load(c[1]) + x * (at.load(c[2]) + x * at.load(c[3])));
  };
  MotionAhead<P> motion{value_of(a.elongation), value_of(a.extension), value_of(a.hardening)};
  const P t = at.load(a.start) + elapsed;
  const Mask oscillates = t < at.load(a.oscillation_end);
  if (!(oscillates & wanted).any()) return motion;
  const friction::OscillationConstants<P> of = load_struct(at, a.oscillation);
  const friction::OscillationPhase<P> now = friction::oscillation_phase(of, P(1.0) - exp(-of.decay * t), t);
  P sine, cosine;
  sine_and_cosine(now.phase, sine, cosine);
  const friction::OscillationState<P> state = friction::oscillation_state(of, now.amplitude, sine, cosine);
  motion.elongation = motion.elongation + select(oscillates, state.elongation, zero);
  motion.extension = motion.extension + select(oscillates, state.extension, zero);
  motion.hardening = motion.hardening + select(oscillates, at.load(a.creep_sign) * state.extension, zero);
  return motion;
}

/// Stores the state `elapsed` (s) after the start of the description (CreepAheadLanes) in the lanes of
/// `where`, with `time_to_stop` (s) as the time to their next stop.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void store_ahead(BatchState& batch, const At& at, const P& elapsed,
                                         const P& time_to_stop, const typename P::Mask& where) {
  const MotionAhead<P> motion = motion_ahead(batch, at, elapsed, where);
  const auto store = [&](Lanes & to, const P& value) __attribute__((always_inline)) {
    at.store(to, select(where, value, at.load(to)));
  };
  store(batch.ahead.elapsed, elapsed);
  store(batch.motion.elongation, motion.elongation);
  store(batch.motion.extension, motion.extension);
  store(batch.motion.hardening, motion.hardening);
  store(batch.time.time_to_stop, time_to_stop);
}

/// Mask of the lanes whose polynomial description (CreepAheadLanes) covers the motion up to the next sample,
/// `elapsed` (s) after its start, and whose torque is still the one under which they came to rest.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask goes_on_ahead(const BatchState& batch, const At& at,
                                                       const P& elapsed) {
  const MotionLanes& m = batch.motion;
  return at.taking_part() & (elapsed <= at.load(batch.ahead.duration)) &
         (at.load(m.torque) == at.load(m.rest_torque)) & (at.load(batch.time.samples_to_stop) == P(1.0));
}

/// Moves one vector of lanes at rest to the next stop, as creep_ahead_kernel() does.
/// @returns mask of the lanes that it has moved.
template <class At>
__attribute__((noinline)) typename At::Vector::Mask creep_ahead(BatchState& batch, const At& at) {
  using P = typename At::Vector;
  const P elapsed = at.load(batch.ahead.elapsed) + at.load(batch.time.time_to_stop);
  const typename P::Mask goes_on = goes_on_ahead(batch, at, elapsed);
  if (goes_on.any()) store_ahead(batch, at, elapsed, P(0.0), goes_on);
  return goes_on;
}

/// Moves lanes at rest to their next stop (the next sample) by the polynomial description of their slow
/// motion (CreepAheadLanes), as long as their torque stays and the description lasts.
/// @returns the lanes that it has moved.
template <class V>
LaneSet creep_ahead_kernel(BatchState& batch, const LaneSet& lanes) {
  LaneSet moved;
  for_each_stretch<V>(
      lanes, [&](const auto& at) { moved.insert_stretch(at.lane(0), creep_ahead(batch, at).bits()); });
  return moved;
}

}  // namespace zerocount::batch
