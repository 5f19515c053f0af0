// Sampling instants of the lanes.
#include <cmath>

#include "core/batch/lane_scheduler.hpp"
#include "core/numerics/power_series.hpp"

namespace zerocount::batch {

void LaneScheduler::take_samples() {
  change_torques();
  bool ended = false;
  LaneSet at_stop = kernels_.lanes_at_stop(batch_);
  for_each_lane(at_stop.in_both(active_), [&](int lane) {
    if (batch_.measures.samples[lane] != batch_.measures.limits.samples[lane]) return;
    end_move(lane, trial_of(lane));
    ended = true;
  });
  if (ended) at_stop = kernels_.lanes_at_stop(batch_);  // the first sample of a new trial may be late
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
    if ((events & driven) != 0) drive_torque(lane, trial);
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

/// Lets the drive of the lane make the torque on the rotor of the decided one. Unless that stays, the next
/// stop is the end of its first piece.
void LaneScheduler::drive_torque(int lane, LaneTrial& trial) {
  LaneDrive& drive = *trial.drive;
  const std::int64_t k = trial.first_sample + static_cast<std::int64_t>(batch_.measures.samples[lane]) - 1;
  drive.send(k, trial.loop ? batch_.loop.given_torque[lane] : batch_.loop.decided[lane]);
  if (drive.stays()) {
    varying_.erase(lane);
    part_.erase(lane);
    batch_.motion.torque[lane] = drive.piece().course.now + batch_.loop.disturbance[lane];
    return;
  }
  if (batch_.course.vibrates[lane] != 0.0) store_vibration(batch_, lane, drive);
  begin_piece(lane, trial);
}

/// Starts the present piece of the lane's drive.
void LaneScheduler::begin_piece(int lane, LaneTrial& trial) {
  const LaneDrive& drive = *trial.drive;
  start_piece(batch_, lane, trial);
  const bool varies = drive.disturbance_varies() || !motion::motor_is_constant(drive.piece().course);
  const bool whole = drive.piece().duration == batch_.time.sample_time[lane];
  for (LaneSet* set : {&varying_, &changing_, &part_}) set->erase(lane);
  if (varies) varying_.insert(lane);
  if (!whole) part_.insert(lane);
  if (!drive.is_last_piece()) changing_.insert(lane);
}

/// Goes on to the next piece of the torque in the lanes that stand within a sample.
void LaneScheduler::change_torques() {
  if (changing_.empty()) return;
  for_each_lane(changing_.in_both(kernels_.lanes_at_stop(batch_)), [&](int lane) {
    LaneTrial& trial = trial_of(lane);
    trial.drive->next_piece();
    begin_piece(lane, trial);
    batch_.time.steps[lane] = 0.0;
  });
}

}  // namespace zerocount::batch
