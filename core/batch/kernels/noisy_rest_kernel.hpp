#pragma once

#include "core/batch/kernels/creep_ahead_kernel.hpp"
#include "core/batch/kernels/lane_group.hpp"
#include "core/batch/kernels/noise.hpp"

namespace zerocount::batch {

/// Passes over samples of one vector of lanes at rest, as noisy_rest_kernel() does.
/// @returns mask of the lanes that have moved.
template <class At>
__attribute__((noinline)) typename At::Vector::Mask noisy_rest(BatchState& batch, const At& at,
                                                               const LaneSet& active, int max_samples) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  const int present = __builtin_popcount(active.stretch(at.lane(0), P::lanes));
  const int enough = present - present / 4;
  if (__builtin_popcount(at.taking_part().bits()) < enough) return Mask::of_bits(0);
  const LoopLanes& l = batch.loop;
  const TimeLanes& time = batch.time;
  NoiseLanes& n = batch.noise;
  const P zero(0.0);
  const P one(1.0);
  const P start = at.load(batch.ahead.elapsed);
  P elapsed = start;
  P to_next = at.load(time.time_to_stop);
  const P to_pass = at.load(batch.measures.limits.samples) - at.load(batch.measures.samples) - one;
  P passed = zero;
  P state = at.load(n.state);
  P disagreements = at.load(n.disagreements);
  Mask running =
      goes_on_ahead(batch, at, elapsed + to_next) & to_mask(at.load(l.steady)) & (at.load(l.driven) == zero);
  for (int i = 0; i < max_samples && __builtin_popcount(running.bits()) >= enough; ++i) {
    const P next = elapsed + to_next;
    running = running & (next <= at.load(batch.ahead.duration));
    const MotionAhead<P> motion = motion_ahead(batch, at, next, running);
    const P theta = at.load(batch.motion.hook) + motion.elongation + motion.extension;
    const NoisyReading<P> reading =
        noisy_reading(batch, at, theta - at.load(l.read_twist), at.load(n.sample) + passed, state);
    const Mask passes = running & (reading.count == at.load(l.count)) & (passed < to_pass);
    elapsed = select(running, next, elapsed);
    to_next = select(passes, at.load(time.sample_time), select(running, zero, to_next));
    passed = passed + select(passes, one, zero);
    state = select(passes, reading.state, state);
    disagreements = disagreements + select(passes, reading.disagrees, zero);
    running = passes;
  }
  const Mask moved = (elapsed != start) & at.taking_part();
  if (!moved.any()) return moved;
  store_ahead(batch, at, elapsed, to_next, moved);
  at.store(n.sample, at.load(n.sample) + passed);
  at.store(n.state, state);
  at.store(n.disagreements, disagreements);
  measure_passed(batch, at, passed);
  return moved;
}

/// Advances lanes that are at rest, with a noisy encoder, over the samples at which the encoder still reads
/// the last count, so that the torque stays. A lane stops at the first sample with another count, at the last
/// sample of the move, at the end of the description of its slow motion (CreepAheadLanes), or after
/// `max_samples` samples. A vector stops once fewer than three quarters of its `active` lanes go on, because
/// the others wait for them.
/// @returns the lanes that it has moved. A lane that is then between two samples has passed at least one
/// sample.
template <class V>
LaneSet noisy_rest_kernel(BatchState& batch, const LaneSet& lanes, const LaneSet& active, int max_samples) {
  LaneSet moved;
  for_each_stretch<V>(lanes, [&](const auto& at) {
    moved.insert_stretch(at.lane(0), noisy_rest(batch, at, active, max_samples).bits());
  });
  return moved;
}

}  // namespace zerocount::batch
