// Sampling instants of the lanes.
#include <cmath>

#include "core/batch/lane_scheduler.hpp"
#include "core/numerics/power_series.hpp"

namespace zerocount::batch {

void LaneScheduler::take_samples() {
  change_torques();
  const LaneSet at_stop = kernels_.lanes_at_stop(batch_).in_both(active_);
  for_each_lane(at_stop, [&](int lane) {
    if (batch_.measures.samples[lane] == batch_.measures.limits.samples[lane]) end_move(lane, trial_of(lane));
  });
  const LaneSet due = at_stop.in_both(active_);
  const LaneSet with_blocks = due.in_both(with_blocks_);
  const LaneSet with_loop = due.in_both(with_loop_);
  sample(kernels_.sample, due.without(with_blocks).without(with_loop));
  sample(kernels_.sample_blocks, with_blocks);
  sample_given(with_loop);
}

/// Lets the LaneLoop of each lane decide.
void LaneScheduler::sample_given(const LaneSet& due) {
  if (due.empty()) return;
  LoopLanes& l = batch_.loop;
  const MotionLanes& m = batch_.motion;
  LaneSet decided = due;
  for_each_lane(due, [&](int lane) {
    const double theta = m.slide_direction[lane] != 0.0
                             ? m.theta[lane]
                             : m.hook[lane] + m.elongation[lane] + m.extension[lane];
    const auto sample_of_move = static_cast<std::int64_t>(batch_.measures.samples[lane]);
    const auto decision = trial_of(lane).loop->sample(sample_of_move, theta);
    if (!decision) {
      decided.erase(lane);
      fall_back_to_scalar(lane);
      return;
    }
    l.given_count[lane] = static_cast<double>(decision->count);
    l.given_code[lane] = static_cast<double>(decision->dac.code);
    l.given_torque[lane] = decision->torque;
    l.given_clipped[lane] = decision->dac.clipped ? 1.0 : 0.0;
    l.given_may_stay[lane] = decision->may_stay ? 1.0 : 0.0;
  });
  sample(kernels_.sample_given, decided);
}

/// Processes the sampling instant of the lanes `due`.
void LaneScheduler::sample(void (*kernel)(BatchState&, const LaneSet&), const LaneSet& due) {
  if (due.empty()) return;
  note_gradual_slides(due);
  kernel(batch_, due);
  for (int i = 0; i < batch_.event_count; ++i) {
    const int lane = batch_.event_lanes[i];
    if ((batch_.events[lane] & beyond_kernel) == 0) continue;
    batch_.events[lane] = no_event;
    batch_.measures.samples[lane] -= 1.0;  // run_trial repeats this sample
    fall_back_to_scalar(lane);
  }
  if (observers_->sample) {
    for_each_lane(due.in_both(active_), [&](int lane) {
      const bool refilled = batch_.measures.samples[lane] == 0.0;
      if (!refilled) record_sample(lane, trial_of(lane));
    });
  }
  for (int i = 0; i < batch_.event_count; ++i) {
    const int lane = batch_.event_lanes[i];
    const int events = batch_.events[lane];
    LaneTrial& trial = trial_of(lane);
    if ((events & jerk_changes) != 0) track_jerk(lane, trial);
    if ((events & count_changes) != 0) follow_last_half(lane, trial);
    if ((events & delayed) != 0) delay_torque(lane, trial);
    if ((events & diverges) != 0) stop_diverged(lane, trial);
  }
}

void LaneScheduler::note_gradual_slides(const LaneSet& due) {
  for_each_lane(due.in_both(bristles_), [&](int lane) {
    if (batch_.motion.gradual_slide[lane] != 0.0) batch_.measures.slid[lane] = 1.0;
  });
}

void LaneScheduler::record_sample(int lane, const LaneTrial& trial) {
  const auto k = static_cast<std::int64_t>(batch_.measures.samples[lane]) - 1;
  const std::int64_t offset = trial.loop ? trial.loop->reference_offset() : 0;
  observers_->sample({trial.number, trial.first_sample + k,
                      static_cast<std::int64_t>(batch_.loop.count[lane]) + offset,
                      static_cast<std::int64_t>(batch_.loop.code[lane]), batch_.measures.theta[lane],
                      batch_.measures.extension[lane], batch_.motion.hardening[lane]});
}

/// Reports the samples within steps, from their series.
void LaneScheduler::record_passed() {
  for (int i = 0; i < batch_.passed_count; ++i) {
    const PassedSamples& p = passed_[i];
    const LaneTrial& trial = trial_of(p.lane);
    const double sample_time = batch_.time.sample_time[p.lane];
    const double rate = batch_.time.sample_rate[p.lane];
    const auto samples = static_cast<std::int64_t>(batch_.measures.samples[p.lane] - p.samples);
    // The stop is `whole` samples after the first.
    const double whole = std::ceil(p.time_to_stop * rate - 1e-9) - 1.0;
    for (int j = 0; j < static_cast<int>(p.samples); ++j) {
      const double x = (p.time_to_stop - (whole - j) * sample_time) / p.step;
      const double extension = batch_.motion.extension[p.lane] +
                               (numerics::value_at(p.creep, x) - numerics::value_at(p.creep, p.end));
      observers_->sample({trial.number, trial.first_sample + samples + j,
                          static_cast<std::int64_t>(batch_.loop.count[p.lane]),
                          static_cast<std::int64_t>(batch_.loop.code[p.lane]),
                          batch_.motion.hook[p.lane] + numerics::value_at(p.elongation, x) + extension,
                          extension, std::abs(numerics::value_at(p.creep, x))});
    }
  }
}

void LaneScheduler::follow_last_half(int lane, LaneTrial& trial) {
  const MeasureLanes& q = batch_.measures;
  const auto k = static_cast<std::int64_t>(q.samples[lane]) - 1;
  const auto count = static_cast<std::int64_t>(batch_.loop.count[lane]);
  const auto change = static_cast<std::int64_t>(q.change[lane]);
  const bool first = k == static_cast<std::int64_t>(q.last_half[lane]);
  trial.last_half.add(k, first ? count : count - change, count);
}

void LaneScheduler::track_jerk(int lane, LaneTrial& trial) {
  const auto k = static_cast<std::int64_t>(batch_.measures.samples[lane]) - 1;
  if (trial.jerks.add(k, static_cast<std::int64_t>(batch_.loop.error[lane]))) report_jerk(trial);
  batch_.measures.in_jerk[lane] = trial.jerks.in_jerk() ? 1.0 : 0.0;
}

void LaneScheduler::report_jerk(LaneTrial& trial) {
  ++trial.reported_jerks;
  if (observers_->jerk) observers_->jerk(trial.number, trial.jerks.last());
}

/// Exchanges the decided torque for the one that acts now. It stays until the next stop only if all waiting
/// torques are equal; otherwise the next stop is the next sample, or before it the change that a delay's
/// fraction of a sample brings.
void LaneScheduler::delay_torque(int lane, LaneTrial& trial) {
  const double decided = batch_.motion.torque[lane];
  const std::size_t size = trial.waiting.size();
  const double newest = trial.waiting[(trial.oldest_waiting + size - 1) % size];
  trial.waiting_alike = decided == newest ? trial.waiting_alike + 1 : 1;
  batch_.motion.torque[lane] = trial.waiting[trial.oldest_waiting];
  trial.waiting[trial.oldest_waiting] = decided;
  trial.oldest_waiting = (trial.oldest_waiting + 1) % size;
  if (trial.waiting_alike > static_cast<std::int64_t>(size)) return;
  TimeLanes& time = batch_.time;
  time.samples_to_stop[lane] = 1.0;
  time.time_to_stop[lane] = time.sample_time[lane];
  const double fraction = batch_.loop.delay[lane] - std::floor(batch_.loop.delay[lane]);
  if (fraction == 0.0) return;
  trial.torque_to_come = trial.waiting[trial.oldest_waiting];
  if (trial.torque_to_come == batch_.motion.torque[lane]) return;
  time.time_to_stop[lane] *= fraction;
  changing_.insert(lane);
}

/// Applies the next torque in the lanes that stand within a sample, where it changes.
void LaneScheduler::change_torques() {
  if (changing_.empty()) return;
  const LaneSet now = changing_.in_both(kernels_.lanes_at_stop(batch_));
  changing_ = changing_.without(now);
  for_each_lane(now, [&](int lane) {
    const double sample_time = batch_.time.sample_time[lane];
    const double fraction = batch_.loop.delay[lane] - std::floor(batch_.loop.delay[lane]);
    batch_.motion.torque[lane] = trial_of(lane).torque_to_come;
    batch_.time.time_to_stop[lane] = sample_time - fraction * sample_time;
    batch_.time.steps[lane] = 0.0;
  });
}

}  // namespace zerocount::batch
