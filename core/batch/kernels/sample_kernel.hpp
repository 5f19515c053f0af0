#pragma once

#include "core/batch/kernels/lane_blocks.hpp"
#include "core/batch/kernels/lane_group.hpp"
#include "core/batch/kernels/noise.hpp"
#include "core/loop/formulas.hpp"

namespace zerocount::batch {

/// Torque of the PID law without further controller blocks, N m. Updates the integral.
/// @param last_count count at the last sample.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P pid_torque(BatchState& batch, const At& at, const ControlInput<P>& in,
                                     const P& last_count) {
  LoopLanes& l = batch.loop;
  const loop::PidConstants<P> gains{at.load(l.kp), at.load(l.ki), at.load(l.kd), at.load(l.lowest_integral),
                                    at.load(l.highest_integral)};
  loop::PidState<P> pid{at.load(l.integral), in.last_error, last_count};
  const P torque = loop::pid_step(gains, pid, in.error, in.count);
  at.store(l.integral, pid.integral);
  return torque;
}

/// Adds sample k of the moves to the measures of their error bands.
/// @param size |e|, counts.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void measure_bands(MeasureLanes& q, const At& at, const P& k, const P& size) {
  for (BandLanes& lanes : q.bands) {
    const P limit = at.load(lanes.limit);
    if (!(size > limit).any()) return;  // nor outside the wider bands
    trial::BandMeasures<P> band{at.load(lanes.last_outside), at.load(lanes.entry), at.load(lanes.exits)};
    trial::measure_band(band, limit, at.load(q.limits.dwell), k, size);
    at.store(lanes.last_outside, band.last_outside);
    at.store(lanes.entry, band.entry);
    at.store(lanes.exits, band.exits);
  }
}

/// Reads the noisy fine encoder at this sample, and updates its noise.
/// @param angle true angle at the encoder, rad.
/// @returns the count.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P noisy_count(BatchState& batch, const At& at, const P& angle) {
  NoiseLanes& n = batch.noise;
  const P k = at.load(n.sample);
  const NoisyReading<P> reading = noisy_reading(batch, at, angle, k, at.load(n.state));
  at.store(n.sample, k + P(1.0));
  at.store(n.state, reading.state);
  at.store(n.disagreements, at.load(n.disagreements) + reading.disagrees);
  return reading.count;
}

/// Processes one sampling instant of one vector of lanes; see sample_kernel().
template <Decider decider, bool noisy, class At>
__attribute__((noinline)) void sample(BatchState& batch, const At& at) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  MotionLanes& m = batch.motion;
  LoopLanes& l = batch.loop;
  MeasureLanes& q = batch.measures;
  TimeLanes& time = batch.time;
  const P extension = at.load(m.extension);
  const Mask hook_slides = to_mask(at.load(m.slide_direction));
  const P theta = select(hook_slides, at.load(m.theta), at.load(m.hook) + at.load(m.elongation) + extension);
  const P angle = theta - at.load(l.read_twist);
  const P resolution = at.load(l.resolution);
  Mask unreadable = ~(abs(theta / resolution) < P(0x1p50));
  P count;
  if constexpr (decider == Decider::lane_loop) {
    count = at.load(l.given_count);
  } else if constexpr (noisy) {
    count = noisy_count(batch, at, angle);
    unreadable = unreadable | ~(abs(count) < P(0x1p50));
  } else {
    count = loop::ideal_count(angle, resolution, at.load(l.phase));
  }
  const Mask counted = to_mask(at.load(l.counted));
  // Before the first sample l.count is n_{−1} − n_0.
  const P stored_count = at.load(l.count);
  const P last_count = select(counted, stored_count, count + stored_count);
  const P last_error = at.load(l.error);
  const P error = at.load(l.target) - count;
  const P change = count - last_count;

  const ControlInput<P> input{error, last_error, count, change, counted};
  const P dac_resolution = at.load(l.dac_resolution);
  P code, torque, applied;
  Mask clipped;
  if constexpr (decider == Decider::lane_loop) {
    code = at.load(l.given_code);
    torque = at.load(l.given_decided);
    applied = at.load(l.converted);
    clipped = to_mask(at.load(l.given_clipped));
  } else {
    P wanted_torque;
    if constexpr (decider == Decider::blocks) {
      wanted_torque = block_torque(batch, at, input);
    } else {
      wanted_torque = pid_torque(batch, at, input, last_count);
    }
    const P wanted = loop::wanted_code(wanted_torque, dac_resolution);
    code = loop::clipped_code(wanted, at.load(l.lowest_code), at.load(l.highest_code));
    applied = torque = code * dac_resolution;
    clipped = code != wanted;
    if constexpr (decider == Decider::blocks) keep_remainder(batch, at, wanted_torque, applied, clipped);
  }

  at.store(l.error, error);
  at.store(l.count, count);
  at.store(l.counted, P(1.0));
  at.store(l.decided, torque);
  if constexpr (decider != Decider::lane_loop) at.store(l.converted, applied);
  at.store(l.code, code);
  at.store(m.torque, applied + at.load(l.disturbance));
  Mask steady = (error == P(0.0)) & (last_error == P(0.0)) & (change == P(0.0));
  if constexpr (decider == Decider::blocks) steady = steady & ~has_memory<P>(batch, at);
  if constexpr (decider == Decider::lane_loop)
    steady = (steady & to_mask(at.load(l.given_may_stay))) | to_mask(at.load(l.given_stays));
  at.store(l.steady, to_number<P>(steady));
  if constexpr (noisy) steady = Mask::of_bits(0);  // any sample may have another count

  const P zero(0.0);
  const P one(1.0);
  trial::RunningMeasures<P> measures;
  trial::for_each_measure(LoadEach<At>{at}, measures, q);
  const trial::MeasureLimits<P> limits{at.load(q.limits.samples), at.load(q.limits.dwell),
                                       at.load(q.limits.window)};
  const P samples = measures.samples;
  const P size = abs(error);
  const P first_error = select(samples == zero, size, at.load(q.first_error));
  const Mask error_diverges = size > at.load(q.max_error) + first_error;
  const Mask dwelt = to_mask(measures.arrived);
  trial::measure_error(measures, limits, error);
  trial::measure_torque(measures, torque, clipped);
  trial::for_each_measure(StoreEach<At>{at}, q, measures);
  measure_bands(q, at, samples, size);
  at.store(q.first_error, first_error);
  at.store(q.theta, theta);
  at.store(q.extension, extension);
  at.store(q.change, change);

  // If the torque is steady, the next stop is the last sample of the move.
  const P remaining = select(steady & ~hook_slides, max(limits.samples - samples - one, one), one);
  at.store(time.samples_to_stop, remaining);
  at.store(time.time_to_stop, remaining * at.load(time.sample_time));
  at.store(time.steps, zero);
  const Mask away = dwelt & (error != zero);
  const Mask back = to_mask(at.load(q.in_jerk));
  const Mask changes = (change != zero) & (samples >= at.load(q.last_half));
  add_events(batch, at,
             events_where<P>(unreadable, beyond_kernel) +
                 events_where<P>(~unreadable & (away | back), jerk_changes) +
                 events_where<P>(~unreadable & changes, count_changes) +
                 events_where<P>(error_diverges, diverges) +
                 events_where<P>(to_mask(at.load(l.driven)), driven));
}

/// Processes one sampling instant of each lane: reads the encoder, runs the controller, converts the torque,
/// and updates the measures of the move.
/// @tparam decider code that decides the torque.
/// @tparam noisy whether the fine encoder has noise. Reports the events jerk_changes, count_changes, diverges
/// and driven, and beyond_kernel where the encoder cannot count θ.
template <class V, Decider decider, bool noisy>
void sample_kernel(BatchState& batch, const LaneSet& lanes) {
  batch.event_count = 0;
  for_each_stretch<V>(lanes, [&](const auto& at) { sample<decider, noisy>(batch, at); });
}

}  // namespace zerocount::batch
