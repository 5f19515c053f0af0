// The way of the lanes from one sampling instant to the next.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/batch/lane_rest.hpp"
#include "core/batch/lane_work.hpp"

namespace zerocount::batch {

void LaneWork::move_sticking() {
  int count = kernels_.list(batch_, sticking, false, list_);
  if (count + waiting_count_ == 0) return;
  kernels_.stick_start(batch_, {list_, count});
  count = prepare_steps(count);
  kernels_.stick_step(batch_, {list_, count});
  end_sticking_steps();
  // Few lanes at a time meet an event: they wait until there are enough of them, or nothing else to do.
  constexpr int enough = 16;
  if (waiting_count_ == 0 || (waiting_count_ < enough && count > waiting_count_)) return;
  const int with_events = std::exchange(waiting_count_, 0);
  std::sort(waiting_, waiting_ + with_events);
  for (int i = 0; i < with_events; ++i) state_of(waiting_[i]) = sticking;
  kernels_.stick_event(batch_, {waiting_, with_events});
  end_sticking_steps();
}

/// Handles the events at the start of a step. Keeps in the list, of `count` lanes, those that still take the
/// step. @returns their number.
int LaneWork::prepare_steps(int count) {
  bool others = false;
  for (int i = 0; i < batch_.event_count; ++i) {
    const int lane = batch_.event_lanes[i];
    const int events = batch_.events[lane];
    LaneTrial& trial = trial_of(lane);
    if ((events & ends_creep) != 0) end_creep(batch_, lane, trial);
    if ((events & may_rest) != 0 && come_to_rest(lane)) {
      others = true;
    } else if ((events & slides) != 0) {
      start_slide(batch_, lane, trial);
      state_of(lane) = sliding;
      others = true;
    } else if (batch_.motion.heading[lane] != batch_.motion.direction[lane]) {
      turn(batch_, lane, trial);
    }
  }
  if (!others) return count;
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const int lane = list_[i];
    if (state_of(lane) == sticking && batch_.time.time_to_stop[lane] != 0.0) list_[kept++] = lane;
  }
  return kept;
}

/// @returns whether the lane was at rest, and has gone on to a sampling instant.
bool LaneWork::come_to_rest(int lane) {
  LaneTrial& trial = trial_of(lane);
  if (!observers_->sample) return rest(batch_, lane, trial, {});
  const auto taken = static_cast<std::int64_t>(batch_.measures.taken[lane]);
  return rest(batch_, lane, trial, [&](double passed, double theta, const friction::CreepState& creep) {
    const std::int64_t k = trial.first_sample + taken - 1 + static_cast<std::int64_t>(passed);
    observers_->sample({trial.number, k, static_cast<std::int64_t>(batch_.loop.count[lane]),
                        static_cast<std::int64_t>(batch_.loop.code[lane]), theta, creep.extension,
                        creep.hardening});
  });
}

/// Handles the events at the end of a step.
void LaneWork::end_sticking_steps() {
  if (observers_->sample) record_passed();
  for (int i = 0; i < batch_.event_count; ++i) {
    const int lane = batch_.event_lanes[i];
    const int events = batch_.events[lane];
    LaneTrial& trial = trial_of(lane);
    if ((events & meets_event) != 0) {
      state_of(lane) = waiting;
      waiting_[waiting_count_++] = lane;
      continue;
    }
    if ((events & closure) != 0) close_loop(batch_, lane, trial);
    if ((events & creep_sets_in) != 0) batch_.motion.creeping[lane] = 1.0;
    if ((events & creep_ends) != 0) end_creep(batch_, lane, trial);
    if ((events & breaks_away) != 0) start_slide(batch_, lane, trial);
    if ((events & beyond_kernel) != 0 && !advance_by_reference(batch_, lane, trial)) {
      fall_back_to_scalar(lane);
      continue;
    }
    state_of(lane) = moving_state(lane);
  }
}

void LaneWork::move_sliding() {
  const int count = kernels_.list(batch_, sliding, false, list_);
  if (count == 0) return;
  int fast = 0;
  int slow = 0;
  for (int i = 0; i < count; ++i) {
    const int lane = list_[i];
    const bool is_fast = std::abs(batch_.motion.omega[lane]) > batch_.contact.fast_velocity[lane];
    (is_fast ? list_[fast++] : slow_list_[slow++]) = lane;
  }
  kernels_.slide_fast(batch_, {list_, fast});
  end_sliding_steps();
  kernels_.slide_slow(batch_, {slow_list_, slow});
  end_sliding_steps();
}

void LaneWork::end_sliding_steps() {
  for (int i = 0; i < batch_.event_count; ++i) {
    const int lane = batch_.event_lanes[i];
    const int events = batch_.events[lane];
    LaneTrial& trial = trial_of(lane);
    if ((events & velocity_zero) != 0) end_slide(batch_, lane, trial);
    if ((events & beyond_kernel) != 0 && !advance_by_reference(batch_, lane, trial)) {
      fall_back_to_scalar(lane);
      continue;
    }
    state_of(lane) = moving_state(lane);
  }
}

}  // namespace zerocount::batch
