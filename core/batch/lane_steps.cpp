// Motion of the lanes from one sampling instant to the next.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/batch/lane_rest.hpp"
#include "core/batch/lane_scheduler.hpp"
#include "core/friction/free_motion.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::batch {

/// Computes the present torque of lanes in which it varies, and its series.
void LaneScheduler::follow_torques(const LaneSet& lanes) {
  CourseLanes& c = batch_.course;
  const MotionLanes& m = batch_.motion;
  for_each_lane(lanes, [&](int lane) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(c.ripple_count[lane]); ++i) {
      const double theta = m.slide_direction[lane] != 0.0
                               ? m.theta[lane]
                               : m.hook[lane] + m.elongation[lane] + m.extension[lane];
      const double angle =
          c.ripples[i].per_angle[lane] * theta + trial_of(lane).drive->disturbance().ripple[i].phase;
      c.ripples[i].sine[lane] = numerics::sin(angle);
      c.ripples[i].cosine[lane] = numerics::cos(angle);
    }
  });
  kernels_.course(batch_, lanes);
}

void LaneScheduler::move_sticking() {
  const LaneSet lanes = sticking_.without(kernels_.lanes_at_stop(batch_));
  if (lanes.empty() && waiting_.empty()) return;
  wake_ahead(lanes);
  const LaneSet varying = lanes.in_both(varying_);
  int stepped = move_sticking(lanes.without(varying), kernels_.constant);
  if (!varying.empty()) {
    follow_torques(varying);
    stepped += move_sticking(varying, kernels_.varying);
  }
  // Few lanes at a time meet an event: they wait until there are enough of them, or no others to move.
  constexpr int enough = 16;
  const int count = waiting_.count();
  if (count == 0 || (count < enough && stepped > count)) return;
  locate_events();
}

/// Brings the plants of lanes up to date whose rest ends because the torque has changed.
void LaneScheduler::wake_ahead(const LaneSet& lanes) {
  if (ahead_.empty()) return;
  for_each_lane(lanes.in_both(ahead_), [&](int lane) {
    if (!varying_.contains(lane) && batch_.motion.torque[lane] == batch_.motion.rest_torque[lane]) return;
    bring_up_to_date(batch_, lane, trial_of(lane));
    ahead_.erase(lane);
  });
}

/// @returns the number of lanes that took a step.
int LaneScheduler::move_sticking(LaneSet lanes, const MotionKernels& kernels) {
  kernels.stick_start(batch_, lanes);
  prepare_steps(lanes);
  kernels.stick_step(batch_, lanes);
  end_sticking_steps();
  return lanes.count();
}

/// Takes the steps of the waiting lanes up to their events.
void LaneScheduler::locate_events() {
  const LaneSet with_events = std::exchange(waiting_, {});
  for_each_lane(with_events, [&](int lane) { sticking_.insert(lane); });
  const LaneSet varying = with_events.in_both(varying_);
  kernels_.constant.stick_event(batch_, with_events.without(varying));
  end_sticking_steps();
  if (varying.empty()) return;
  kernels_.varying.stick_event(batch_, varying);
  end_sticking_steps();
}

/// Advances the lane to its next stop by the scalar plant. @returns whether the motion stayed finite.
bool LaneScheduler::follow_reference(int lane, LaneTrial& trial) {
  return advance_by_reference(batch_, lane, trial,
                              varying_.contains(lane) ? present_course(batch_, lane)
                                                      : motion::constant_torque(batch_.motion.torque[lane]));
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
  if (varying_.contains(lane)) {
    if (!follow_reference(lane, trial)) fall_back_to_scalar(lane);
    if (!is_idle(lane)) set_moving(lane);
    return true;
  }
  PassedSample passed;
  if (observers_->sample) {
    passed = [&, samples = static_cast<std::int64_t>(batch_.measures.samples[lane])](
                 double number, double theta, const friction::CreepState& creep) {
      const std::int64_t k = trial.first_sample + samples - 1 + static_cast<std::int64_t>(number);
      observers_->sample({trial.number, k, static_cast<std::int64_t>(batch_.loop.count[lane]),
                          static_cast<std::int64_t>(batch_.loop.code[lane]), theta, creep.extension,
                          creep.hardening});
    };
  }
  const bool rests = rest(batch_, lane, trial, passed);
  ahead_.erase(lane);
  if (rests && trial.ahead.elapsed > 0.0) ahead_.insert(lane);
  return rests;
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
    if ((events & beyond_kernel) != 0 && !follow_reference(lane, trial)) {
      fall_back_to_scalar(lane);
      continue;
    }
    set_moving(lane);
  }
}

void LaneScheduler::move_sliding() {
  const LaneSet lanes = sliding_.without(kernels_.lanes_at_stop(batch_));
  if (lanes.empty()) return;
  const LaneSet varying = lanes.in_both(varying_);
  move_sliding(lanes.without(varying), kernels_.constant);
  if (varying.empty()) return;
  follow_torques(varying);
  move_sliding(varying, kernels_.varying);
}

void LaneScheduler::move_sliding(const LaneSet& lanes, const MotionKernels& kernels) {
  const LaneSet fast = lanes.in_both(kernels_.fast_lanes(batch_));
  kernels.slide_fast(batch_, fast);
  end_sliding_steps();
  kernels.slide_slow(batch_, lanes.without(fast));
  end_sliding_steps();
}

void LaneScheduler::end_sliding_steps() {
  for (int i = 0; i < batch_.event_count; ++i) {
    const int lane = batch_.event_lanes[i];
    const int events = batch_.events[lane];
    LaneTrial& trial = trial_of(lane);
    if ((events & velocity_zero) != 0) end_slide(batch_, lane, trial);
    if ((events & beyond_kernel) != 0 && !follow_reference(lane, trial)) {
      fall_back_to_scalar(lane);
      continue;
    }
    set_moving(lane);
  }
}

void LaneScheduler::move_bristles() {
  if (bristles_.empty()) return;
  const LaneSet lanes = bristles_.without(kernels_.lanes_at_stop(batch_));
  const LaneSet varying = lanes.in_both(varying_);
  move_bristles(kernels_.bristle_rest(batch_, lanes.without(varying)), kernels_.constant);
  if (varying.empty()) return;
  follow_torques(varying);
  move_bristles(varying, kernels_.varying);
}

void LaneScheduler::move_bristles(const LaneSet& lanes, const MotionKernels& kernels) {
  const LaneSet fast = lanes.in_both(kernels_.fast_lanes(batch_));
  kernels.bristle_fast(batch_, fast);
  rerun_lost_lanes();
  kernels.bristle_slow(batch_, lanes.without(fast));
  rerun_lost_lanes();
}

/// Runs the lanes that the last kernel could not follow by the reference.
void LaneScheduler::rerun_lost_lanes() {
  for (int i = 0; i < batch_.event_count; ++i) fall_back_to_scalar(batch_.event_lanes[i]);
}

void LaneScheduler::move_free() {
  if (free_.empty()) return;
  const LaneSet lanes = free_.without(kernels_.lanes_at_stop(batch_));
  const LaneSet part = lanes.in_both(part_);
  const LaneSet varying = lanes.in_both(varying_).without(part);
  kernels_.constant.free(batch_, lanes.without(part).without(varying));
  if (!varying.empty()) kernels_.varying.free(batch_, varying);
  for_each_lane(part, [&](int lane) {
    MotionLanes& m = batch_.motion;
    const friction::FreeMotion end =
        friction::free_motion(trial_of(lane).parameters->plant, {m.theta[lane], m.omega[lane]},
                              present_course(batch_, lane), batch_.time.time_to_stop[lane]);
    m.theta[lane] = end.theta;
    m.omega[lane] = end.omega;
    batch_.time.time_to_stop[lane] = 0.0;
  });
}

}  // namespace zerocount::batch
