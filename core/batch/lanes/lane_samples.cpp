// Sampling instants of the lanes.
#include <algorithm>

#include "core/batch/lanes/running_batch.hpp"

namespace zerocount::batch {
namespace {

void follow_last_half(RunningBatch& run, int lane, LaneTrial& trial) {
  const MeasureLanes& q = run.state.measures;
  const std::int64_t k = run.samples_of(lane) - 1;
  const auto count = static_cast<std::int64_t>(run.state.loop.count[lane]);
  const auto change = static_cast<std::int64_t>(q.change[lane]);
  const bool first = k == static_cast<std::int64_t>(q.last_half[lane]);
  trial.last_half.add(k, first ? count : count - change, count);
}

void follow_jerk(RunningBatch& run, int lane, LaneTrial& trial) {
  const auto error = static_cast<std::int64_t>(run.state.loop.error[lane]);
  if (trial.jerks.add(run.samples_of(lane) - 1, error)) report_jerk(run, trial);
  run.state.measures.in_jerk[lane] = trial.jerks.in_jerk() ? 1.0 : 0.0;
}

/// Runs the trials of those lanes anew by the scalar engine whose encoder could not count the angle θ at this
/// sample.
void rerun_unreadable(RunningBatch& run) {
  BatchState& batch = run.state;
  for (int i = 0; i < batch.event_count; ++i) {
    const int lane = batch.event_lanes[i];
    if ((batch.events[lane] & beyond_kernel) == 0) continue;
    batch.events[lane] = no_event;
    batch.measures.samples[lane] -= 1.0;  // run_trial() repeats this sample
    fall_back_to_scalar(run, lane);
  }
}

/// Processes the sampling instant of the lanes `due` by the given sampling kernel.
void sample(RunningBatch& run, void (*kernel)(BatchState&, const LaneSet&), const LaneSet& due) {
  if (due.empty()) return;
  BatchState& batch = run.state;
  for_each_lane(due.in_both(run.lanes.bristles), [&](int lane) {
    if (batch.motion.gradual_slide[lane] != 0.0) batch.measures.slid[lane] = 1.0;
  });
  kernel(batch, due);
  if (const LaneSet amplified = due.in_both(run.lanes.amplified); !amplified.empty()) amplify(run, amplified);
  rerun_unreadable(run);
  if (run.observers->sample) {
    for_each_lane(due.in_both(run.lanes.active), [&](int lane) {
      const bool has_new_trial = batch.measures.samples[lane] == 0.0;
      if (!has_new_trial) report_sample(run, lane);
    });
  }
  for (int i = 0; i < batch.event_count; ++i) {
    const int lane = batch.event_lanes[i];
    const int events = batch.events[lane];
    LaneTrial& trial = run.trial_of(lane);
    if ((events & jerk_changes) != 0) follow_jerk(run, lane, trial);
    if ((events & count_changes) != 0) follow_last_half(run, lane, trial);
    if ((events & driven) != 0) drive_torque(run, lane);
    if ((events & diverges) != 0) stop_diverged(run, lane);
  }
}

/// Lets the LaneLoop of each lane in `due` decide its torque.
/// @returns the lanes whose LaneLoop gave a decision.
LaneSet decide_in_loops(RunningBatch& run, const LaneSet& due) {
  LoopLanes& l = run.state.loop;
  LaneSet decided = due;
  for_each_lane(due, [&](int lane) {
    const double rotor = theta_of(run.state, lane);
    const double read = rotor - l.read_twist[lane];
    const double other = l.read_twist[lane] != 0.0 ? rotor : rotor - run.state.load.twist[lane];
    const auto decision = run.trial_of(lane).loop->sample(run.samples_of(lane), read, other);
    if (!decision) {
      decided.erase(lane);
      fall_back_to_scalar(run, lane);
      return;
    }
    l.given_count[lane] = static_cast<double>(decision->count);
    l.given_code[lane] = static_cast<double>(decision->dac.code);
    l.given_decided[lane] = decision->dac.torque;
    l.converted[lane] = decision->torque;
    l.given_clipped[lane] = decision->dac.clipped ? 1.0 : 0.0;
    l.given_may_stay[lane] = decision->may_stay ? 1.0 : 0.0;
    l.given_stays[lane] = decision->stays ? 1.0 : 0.0;
  });
  return decided;
}

/// Measures the position error of each lane in `due` at this sample, and finds out within which positions its
/// next samples may be passed over.
void measure_position(RunningBatch& run, const LaneSet& due) {
  LoopLanes& l = run.state.loop;
  for_each_lane(due.in_both(run.lanes.with_position), [&](int lane) {
    if (run.samples_of(lane) == 0) return;  // a new trial
    trial::PositionError& position = *run.trial_of(lane).position;
    const double angle = run.state.measures.theta[lane] - run.trial_of(lane).read_twist;
    position.add_at_target(run.samples_of(lane) - 1, angle);
    const trial::PositionError::Range quiet = position.quiet_range();
    const auto in_counts = [&](double theta) {
      return theta / l.resolution[lane] + l.phase[lane] - l.count[lane];
    };
    l.quiet_from[lane] = std::max(in_counts(quiet.low), 0.0);
    l.quiet_to[lane] = std::min(in_counts(quiet.high), 1.0);
  });
}

}  // namespace

void take_samples(RunningBatch& run, const LaneSet& due) {
  for_each_lane(due.in_both(run.lanes.before_start), [&](int lane) {
    start_slides(run.state, lane, run.trial_of(lane));
    run.lanes.before_start.erase(lane);
  });
  for_each_lane(due.in_both(run.lanes.loaded),
                [&](int lane) { run.trial_of(lane).read_twist = run.state.loop.read_twist[lane]; });
  const LaneSet with_blocks = due.in_both(run.lanes.with_blocks);
  const LaneSet with_loop = due.in_both(run.lanes.with_loop);
  const LaneSet plain = due.without(with_blocks).without(with_loop);
  const LaneSet& noisy = run.lanes.noisy;
  sample(run, run.kernels.sample, plain.without(noisy));
  sample(run, run.kernels.sample_blocks, with_blocks.without(noisy));
  sample(run, run.kernels.sample_noisy, plain.in_both(noisy));
  sample(run, run.kernels.sample_noisy_blocks, with_blocks.in_both(noisy));
  if (!with_loop.empty()) sample(run, run.kernels.sample_given, decide_in_loops(run, with_loop));
  if (!run.lanes.with_position.empty()) measure_position(run, due);
}

}  // namespace zerocount::batch
