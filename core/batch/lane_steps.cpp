// Motion of the lanes from one sampling instant to the next.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/batch/lane_rest.hpp"
#include "core/batch/lane_scheduler.hpp"

namespace zerocount::batch {
namespace {

/// The lanes that move faster than ContactLanes::fast_velocity.
LaneSet fast_lanes(const BatchState& batch, const LaneSet& lanes) {
  LaneSet fast;
  for_each_lane(lanes, [&](int lane) {
    if (std::abs(batch.motion.omega[lane]) > batch.contact.fast_velocity[lane]) fast.insert(lane);
  });
  return fast;
}

}  // namespace

void LaneScheduler::move_sticking() {
  LaneSet lanes = sticking_.without(kernels_.lanes_at_stop(batch_));
  if (lanes.empty() && waiting_.empty()) return;
  kernels_.stick_start(batch_, lanes);
  prepare_steps(lanes);
  kernels_.stick_step(batch_, lanes);
  end_sticking_steps();
  // Few lanes at a time meet an event: they wait until there are enough of them, or no others to move.
  constexpr int enough = 16;
  const int count = waiting_.count();
  if (count == 0 || (count < enough && lanes.count() > count)) return;
  const LaneSet with_events = std::exchange(waiting_, {});
  for_each_lane(with_events, [&](int lane) { sticking_.insert(lane); });
  kernels_.stick_event(batch_, with_events);
  end_sticking_steps();
}

/// Handles the events at the start of a step. Removes the lanes that do not take the step from `lanes`.
void LaneScheduler::prepare_steps(LaneSet& lanes) {
  for (int i = 0; i < batch_.event_count; ++i) {
    const int lane = batch_.event_lanes[i];
    const int events = batch_.events[lane];
    LaneTrial& trial = trial_of(lane);
    if ((events & creep_off) != 0) end_creep(batch_, lane, trial);
    if ((events & may_rest) != 0 && come_to_rest(lane)) {
      lanes.erase(lane);
    } else if ((events & breakaway) != 0) {
      start_slide(batch_, lane, trial);
      set_moving(lane);
      lanes.erase(lane);
    } else if (batch_.motion.heading[lane] != batch_.motion.direction[lane]) {
      turn(batch_, lane, trial);
    }
  }
}

/// @returns whether the lane was at rest; then it is at a sampling instant.
bool LaneScheduler::come_to_rest(int lane) {
  LaneTrial& trial = trial_of(lane);
  if (!observers_->sample) return rest(batch_, lane, trial, {});
  const auto samples = static_cast<std::int64_t>(batch_.measures.samples[lane]);
  return rest(batch_, lane, trial, [&](double passed, double theta, const friction::CreepState& creep) {
    const std::int64_t k = trial.first_sample + samples - 1 + static_cast<std::int64_t>(passed);
    observers_->sample({trial.number, k, static_cast<std::int64_t>(batch_.loop.count[lane]),
                        static_cast<std::int64_t>(batch_.loop.code[lane]), theta, creep.extension,
                        creep.hardening});
  });
}

/// Handles the events at the end of a step.
void LaneScheduler::end_sticking_steps() {
  if (observers_->sample) record_passed();
  for (int i = 0; i < batch_.event_count; ++i) {
    const int lane = batch_.event_lanes[i];
    const int events = batch_.events[lane];
    LaneTrial& trial = trial_of(lane);
    if ((events & meets_event) != 0) {
      sticking_.erase(lane);
      waiting_.insert(lane);
      continue;
    }
    if ((events & closure) != 0) close_loop(batch_, lane, trial);
    if ((events & creep_on) != 0) batch_.motion.creeping[lane] = 1.0;
    if ((events & creep_off) != 0) end_creep(batch_, lane, trial);
    if ((events & breakaway) != 0) start_slide(batch_, lane, trial);
    if ((events & beyond_kernel) != 0 && !advance_by_reference(batch_, lane, trial)) {
      fall_back_to_scalar(lane);
      continue;
    }
    set_moving(lane);
  }
}

void LaneScheduler::move_sliding() {
  const LaneSet lanes = sliding_.without(kernels_.lanes_at_stop(batch_));
  if (lanes.empty()) return;
  const LaneSet fast = fast_lanes(batch_, lanes);
  kernels_.slide_fast(batch_, fast);
  end_sliding_steps();
  kernels_.slide_slow(batch_, lanes.without(fast));
  end_sliding_steps();
}

void LaneScheduler::end_sliding_steps() {
  for (int i = 0; i < batch_.event_count; ++i) {
    const int lane = batch_.event_lanes[i];
    const int events = batch_.events[lane];
    LaneTrial& trial = trial_of(lane);
    if ((events & velocity_zero) != 0) end_slide(batch_, lane, trial);
    if ((events & beyond_kernel) != 0 && !advance_by_reference(batch_, lane, trial)) {
      fall_back_to_scalar(lane);
      continue;
    }
    set_moving(lane);
  }
}

void LaneScheduler::move_bristles() {
  if (bristles_.empty()) return;
  const LaneSet lanes = kernels_.bristle_rest(batch_, bristles_.without(kernels_.lanes_at_stop(batch_)));
  const LaneSet fast = fast_lanes(batch_, lanes);
  kernels_.bristle_fast(batch_, fast);
  rerun_lost_lanes();
  kernels_.bristle_slow(batch_, lanes.without(fast));
  rerun_lost_lanes();
}

/// Runs the lanes that the last kernel could not follow by the reference.
void LaneScheduler::rerun_lost_lanes() {
  for (int i = 0; i < batch_.event_count; ++i) fall_back_to_scalar(batch_.event_lanes[i]);
}

void LaneScheduler::move_free() {
  if (free_.empty()) return;
  kernels_.free(batch_, free_.without(kernels_.lanes_at_stop(batch_)));
}

}  // namespace zerocount::batch
