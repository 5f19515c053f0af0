#pragma once

#include "core/batch/lane_group.hpp"

namespace zerocount::batch {

/// One sampling instant of each lane: encoder, control, converter, measures; as Measurement, PidController,
/// convert() and MoveMeasures have them, operation by operation. Notes jerk_changes and count_changes, and
/// beyond_kernel where the encoder could not count θ.
template <class P>
void sample_kernel(Tile& tile, LaneList list) {
  using Truth = typename P::Truth;
  MotionLanes& m = tile.motion;
  LoopLanes& l = tile.loop;
  MeasureLanes& q = tile.measures;
  TimeLanes& time = tile.time;
  tile.noted_count = 0;
  for (int first = 0, next = 0; first < list.count; first = next) {
    const LaneGroup<P> at(list, first);
    next = first + at.used();
    const P extension = at.load(m.extension);
    const Truth sliding = truth(at.load(m.slide_direction));
    const P theta = select(sliding, at.load(m.theta), at.load(m.hook) + at.load(m.elongation) + extension);
    const P turns = theta / at.load(l.resolution);
    const Truth unreadable = ~(magnitude(turns) < P(0x1p50));
    const P count = floor_of(turns + at.load(l.phase));
    const P last_count = select(truth(at.load(l.counted)), at.load(l.count), count);
    const P last_error = at.load(l.error);
    const P error = at.load(l.target) - count;

    // Control
    const P change = count - last_count;
    P integral = at.load(l.integral) + at.load(l.ki) * (error + last_error);
    integral = smaller(larger(integral, at.load(l.lowest_integral)), at.load(l.highest_integral));
    const P wanted_torque = integral + at.load(l.kp) * error - at.load(l.kd) * change;
    const P dac_resolution = at.load(l.dac_resolution);
    const P lowest = at.load(l.lowest_code);
    const P highest = at.load(l.highest_code);
    // Farther out than any code, a wanted code need not be whole to be clipped.
    const P reached = smaller(larger(wanted_torque / dac_resolution, P(-0x1p50)), P(0x1p50));
    const P wanted = nearest_whole(reached);
    const P code = smaller(larger(wanted, lowest), highest);
    const P torque = code * dac_resolution;

    at.store(l.integral, integral);
    at.store(l.error, error);
    at.store(l.count, count);
    at.store(l.counted, P(1.0));
    at.store(l.decided, torque);
    at.store(l.code, code);
    at.store(m.torque, torque);
    const Truth steady = (error == P(0.0)) & (last_error == P(0.0)) & (change == P(0.0));
    at.store(l.steady, number<P>(steady));

    // Measures
    const P zero(0.0);
    const P one(1.0);
    const P taken = at.load(q.taken);
    const P samples = at.load(q.samples);
    const P size = magnitude(error);
    const P first_error = select(taken == zero, size, at.load(q.first_error));
    at.store(q.first_error, first_error);
    const Truth lost = size > at.load(q.largest_error) + first_error;
    const P move_direction = select(taken == zero, sign(error), at.load(q.move_direction));
    const Truth dwelt = truth(at.load(q.arrived));
    const P zeros = select(error == zero, at.load(q.zeros_in_a_row) + one, zero);
    const P dwell = at.load(q.dwell);
    const Truth arrives = ~dwelt & (zeros == dwell);
    const P since = at.load(q.largest_since_arrival);
    const P in_window = at.load(q.largest_in_window);
    at.store(q.move_direction, move_direction);
    at.store(q.zeros_in_a_row, zeros);
    at.store(q.arrived, number<P>(dwelt | arrives));
    at.store(q.arrival, select(arrives, taken - dwell + one, at.load(q.arrival)));
    at.store(q.largest_since_arrival, select(dwelt, larger(since, size), since));
    at.store(q.largest_in_window,
             select(taken >= samples - at.load(q.window), larger(in_window, size), in_window));
    at.store(q.overshoot, larger(at.load(q.overshoot), -move_direction * error));
    at.store(q.peak_torque, larger(at.load(q.peak_torque), magnitude(torque)));
    at.store(q.saturated, select(code != wanted, one, at.load(q.saturated)));
    at.store(q.theta, theta);
    at.store(q.extension, extension);
    at.store(q.change, change);
    at.store(q.taken, taken + one);

    // Up to the last sample of the move no one is needed where the torque stays.
    const P left = select(steady & ~sliding, larger(samples - taken - one, one), one);
    at.store(time.samples_left, left);
    at.store(time.until, left * at.load(time.sample_time));
    at.store(time.steps, zero);
    const Truth away = dwelt & (error != zero);
    const Truth back = truth(at.load(q.in_jerk));
    const Truth changes = (change != zero) & (taken >= at.load(q.last_half));
    at.note(tile, noted<P>(unreadable, beyond_kernel) + noted<P>(~unreadable & (away | back), jerk_changes) +
                      noted<P>(~unreadable & changes, count_changes) + noted<P>(lost, diverges) +
                      noted<P>(truth(at.load(l.delay)), delayed));
  }
}

}  // namespace zerocount::batch
