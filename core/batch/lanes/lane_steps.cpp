// Steps of the lanes from one sampling instant to the next.
#include <array>
#include <utility>

#include "core/batch/lanes/running_batch.hpp"
#include "core/friction/sliding/none.hpp"

namespace zerocount::batch {
namespace {

/// Largest number of samples that one call of noisy_rest_kernel() may pass over.
constexpr int max_passed_samples = 256;

/// Applies the rest rule to the lane.
/// @returns whether the lane was at rest; then it is at a sampling instant.
bool rests(RunningBatch& run, int lane) {
  if (!run.lanes.varying.contains(lane)) return come_to_rest(run, lane);
  follow_reference(run, lane);
  if (run.lanes.active.contains(lane)) set_motion(run, lane);
  return true;
}

/// Brings the scalar plants up to date in those lanes whose rest, described ahead by polynomials, ends
/// because the torque has changed.
void wake_ahead(RunningBatch& run, const LaneSet& lanes) {
  if (run.lanes.ahead.empty()) return;
  const MotionLanes& m = run.state.motion;
  for_each_lane(lanes.in_both(run.lanes.ahead), [&](int lane) {
    if (!run.lanes.varying.contains(lane) && m.torque[lane] == m.rest_torque[lane]) return;
    bring_up_to_date(run.state, lane, run.trial_of(lane));
    run.lanes.ahead.erase(lane);
  });
}

/// Handles the events at the start of a step of lanes whose hook sticks. Removes the lanes that do not take
/// the step from `lanes`.
void start_sticking_steps(RunningBatch& run, LaneSet& lanes) {
  BatchState& batch = run.state;
  for (int i = 0; i < batch.event_count; ++i) {
    const int lane = batch.event_lanes[i];
    const int events = batch.events[lane];
    LaneTrial& trial = run.trial_of(lane);
    if ((events & creep_off) != 0) end_creep(batch, lane, trial);
    if ((events & may_rest) != 0 && rests(run, lane)) {
      lanes.erase(lane);
    } else if ((events & breakaway) != 0) {
      break_away(batch, lane, trial);
      set_motion(run, lane);
      lanes.erase(lane);
    } else if (batch.motion.heading[lane] != batch.motion.direction[lane]) {
      reverse(batch, lane, trial);
    }
  }
}

/// Handles the events at the end of a step of lanes whose hook sticks.
void end_sticking_steps(RunningBatch& run) {
  if (run.observers->sample) report_passed_samples(run);
  BatchState& batch = run.state;
  for (int i = 0; i < batch.event_count; ++i) {
    const int lane = batch.event_lanes[i];
    const int events = batch.events[lane];
    LaneTrial& trial = run.trial_of(lane);
    if ((events & meets_event) != 0) {
      run.lanes.sticking.erase(lane);
      run.lanes.waiting.insert(lane);
      continue;
    }
    if ((events & closure) != 0) close_loop(batch, lane, trial);
    if ((events & creep_on) != 0) batch.motion.creeping[lane] = 1.0;
    if ((events & creep_off) != 0) end_creep(batch, lane, trial);
    if ((events & breakaway) != 0) break_away(batch, lane, trial);
    if ((events & beyond_kernel) != 0 && !follow_reference(run, lane)) continue;
    set_motion(run, lane);
  }
}

/// One integration step of lanes whose hook sticks, under this forcing.
/// @returns the number of lanes that took a step.
int step_sticking(RunningBatch& run, LaneSet lanes, Forcing forcing) {
  const LaneSet varying = lanes.in_both(run.lanes.varying);
  for (const bool varies : {false, true}) {
    const LaneSet starting = varies ? varying : lanes.without(varying);
    if (starting.empty()) continue;
    run.kernels.stick_start(run.state, starting, {varies, forcing.loaded});
    start_sticking_steps(run, lanes);
  }
  // The path of a load between samples is not monotonic.
  for_each_lane(lanes.in_both(run.lanes.loaded), [&](int lane) { stop_at_next_sample(run.state, lane); });
  run.kernels.stick_step(run.state, lanes, forcing);
  end_sticking_steps(run);
  return lanes.count();
}

/// Advances the lanes in LaneStates::waiting to the events in their steps.
void locate_events(RunningBatch& run) {
  const LaneSet waiting = std::exchange(run.lanes.waiting, {});
  for_each_lane(waiting, [&](int lane) { run.lanes.sticking.insert(lane); });
  for (const auto& [forcing, lanes] : by_forcing(run, waiting)) {
    if (lanes.empty()) continue;
    run.kernels.stick_event(run.state, lanes, forcing);
    end_sticking_steps(run);
  }
}

void end_sliding_steps(RunningBatch& run) {
  for (int i = 0; i < run.state.event_count; ++i) {
    const int lane = run.state.event_lanes[i];
    const int events = run.state.events[lane];
    if ((events & velocity_zero) != 0) re_stick(run.state, lane, run.trial_of(lane));
    if ((events & beyond_kernel) != 0 && !follow_reference(run, lane)) continue;
    set_motion(run, lane);
  }
}

void step_sliding(RunningBatch& run, const LaneSet& lanes, Forcing forcing) {
  const LaneSet fast = lanes.in_both(run.kernels.fast_lanes(run.state));
  run.kernels.slide_fast(run.state, fast, forcing);
  end_sliding_steps(run);
  run.kernels.slide_slow(run.state, lanes.without(fast), forcing);
  end_sliding_steps(run);
}

/// Runs the trials of those lanes anew by the scalar engine whose motion the last kernel could not follow.
void rerun_lost_lanes(RunningBatch& run) {
  for (int i = 0; i < run.state.event_count; ++i) fall_back_to_scalar(run, run.state.event_lanes[i]);
}

void step_bristles(RunningBatch& run, const LaneSet& lanes, Forcing forcing) {
  const LaneSet fast = lanes.in_both(run.kernels.fast_lanes(run.state));
  run.kernels.bristle_fast(run.state, fast, forcing);
  rerun_lost_lanes(run);
  run.kernels.bristle_slow(run.state, lanes.without(fast), forcing);
  rerun_lost_lanes(run);
}

void step_elements(RunningBatch& run, const LaneSet& lanes, Forcing forcing) {
  run.kernels.elements(run.state, lanes, forcing);
  rerun_lost_lanes(run);
}

/// Advances the lanes that are at rest under a constant torque to their next stop.
/// @returns the other lanes.
LaneSet without_resting(RunningBatch& run, const LaneSet& lanes, Forcing forcing, Kernels::Rest rest) {
  const LaneSet steady = lanes.without(run.lanes.varying);
  return steady.empty() ? lanes : lanes.without(steady.without(rest(run.state, steady, forcing)));
}

LaneSet between_stops(const RunningBatch& run, const LaneSet& lanes) {
  return lanes.without(run.kernels.lanes_at_stop(run.state));
}

/// Moves lanes without friction through a part of a sample, where the torque does not last exactly one sample
/// time.
void move_free_part(RunningBatch& run, const LaneSet& lanes) {
  MotionLanes& m = run.state.motion;
  TimeLanes& time = run.state.time;
  for_each_lane(lanes, [&](int lane) {
    const friction::FreeMotion end =
        friction::free_motion(run.trial_of(lane).parameters->plant, {m.theta[lane], m.omega[lane]},
                              present_course(run.state, lane), time.time_to_stop[lane]);
    m.theta[lane] = end.theta;
    m.omega[lane] = end.omega;
    time.time_to_stop[lane] = 0.0;
  });
}

/// One integration step of lanes without friction and with a second mass.
void move_loaded_free(RunningBatch& run, const LaneSet& lanes) {
  follow_torques_of(run, lanes);
  for (const auto& [forcing, some] : by_forcing(run, lanes)) {
    if (some.empty()) continue;
    run.kernels.free_loaded(run.state, some, forcing);
    rerun_lost_lanes(run);
  }
}

/// The lanes at rest whose torque stays until the reading of their noisy encoder changes.
LaneSet waiting_for_noise(const RunningBatch& run, const LaneSet& ahead) {
  LaneSet lanes = ahead.in_both(run.lanes.noisy).without(run.lanes.with_position);
  const DriveLanes& d = run.state.drive;
  for_each_lane(lanes.in_both(run.lanes.amplified), [&](int lane) {
    const bool stays = d.jitter[lane] == 0.0 && d.alike[lane] > d.delay[lane];
    if (!stays) lanes.erase(lane);
  });
  return lanes;
}

/// Advances lanes at rest along the polynomial description of their slow motion.
/// @returns the lanes that it has moved.
LaneSet follow_descriptions(RunningBatch& run, const LaneSet& ahead) {
  LaneSet moved;
  if (const LaneSet noisy = waiting_for_noise(run, ahead); !noisy.empty()) {
    const bool observed = static_cast<bool>(run.observers->sample);
    moved = run.kernels.noisy_rest(run.state, noisy, run.lanes.active, observed ? 1 : max_passed_samples);
    if (observed) report_passed_at_rest(run, moved);
  }
  const LaneSet others = ahead.without(moved);
  const LaneSet also = run.kernels.creep_ahead(run.state, others);
  for_each_lane(also, [&](int lane) { moved.insert(lane); });
  return moved;
}

}  // namespace

bool follow_reference(RunningBatch& run, int lane) {
  const bool varies = run.lanes.varying.contains(lane);
  const motion::TorqueCourse torque =
      varies ? present_course(run.state, lane) : motion::constant_torque(run.state.motion.torque[lane]);
  if (advance_by_reference(run.state, lane, run.trial_of(lane), torque)) return true;
  fall_back_to_scalar(run, lane);
  return false;
}

std::array<std::pair<Forcing, LaneSet>, 4> by_forcing(const RunningBatch& run, const LaneSet& lanes) {
  const LaneSet loaded = lanes.in_both(run.lanes.loaded);
  const LaneSet alone = lanes.without(loaded);
  const LaneSet& varying = run.lanes.varying;
  const LaneSet& driven = run.lanes.loaded_driven;
  return {{{{.varies = false, .loaded = false}, alone.without(varying)},
           {{.varies = true, .loaded = false}, alone.in_both(varying)},
           {{.varies = false, .loaded = true}, loaded.without(driven)},
           {{.varies = true, .loaded = true}, loaded.in_both(driven)}}};
}

void follow_torques_of(RunningBatch& run, const LaneSet& lanes) {
  for (const LaneSet& set : {run.lanes.varying.without(run.lanes.loaded), run.lanes.loaded_driven}) {
    const LaneSet some = lanes.in_both(set);
    if (!some.empty()) run.kernels.course(run.state, some);
  }
}

void move_sticking(RunningBatch& run) {
  LaneSet lanes = between_stops(run, run.lanes.sticking);
  if (lanes.empty() && run.lanes.waiting.empty()) return;
  const LaneSet ahead = lanes.in_both(run.lanes.ahead).without(run.lanes.varying);
  if (!ahead.empty()) lanes = lanes.without(follow_descriptions(run, ahead));
  wake_ahead(run, lanes);
  follow_torques_of(run, lanes);
  int stepped = 0;
  for (const auto& [forcing, some] : by_forcing(run, lanes)) {
    if (!some.empty()) stepped += step_sticking(run, some, forcing);
  }
  // Few lanes at a time meet an event: they wait until there are enough of them, or no others to move.
  constexpr int enough = 16;
  const int waiting = run.lanes.waiting.count();
  if (waiting > 0 && (waiting >= enough || waiting >= stepped)) locate_events(run);
}

void move_sliding(RunningBatch& run) {
  const LaneSet lanes = between_stops(run, run.lanes.sliding);
  if (lanes.empty()) return;
  follow_torques_of(run, lanes);
  for (const auto& [forcing, some] : by_forcing(run, lanes)) {
    if (!some.empty()) step_sliding(run, some, forcing);
  }
}

void move_bristles(RunningBatch& run) {
  if (run.lanes.bristles.empty()) return;
  const LaneSet lanes = between_stops(run, run.lanes.bristles);
  follow_torques_of(run, lanes);
  for (const auto& [forcing, some] : by_forcing(run, lanes)) {
    const LaneSet elements = some.in_both(run.lanes.elements);
    const LaneSet bristles = some.without(elements);
    if (!bristles.empty())
      step_bristles(run, without_resting(run, bristles, forcing, run.kernels.bristle_rest), forcing);
    if (!elements.empty())
      step_elements(run, without_resting(run, elements, forcing, run.kernels.elements_rest), forcing);
  }
}

void move_free(RunningBatch& run) {
  if (run.lanes.free.empty()) return;
  const LaneSet lanes = between_stops(run, run.lanes.free);
  const LaneSet loaded = lanes.in_both(run.lanes.loaded);
  const LaneSet part = lanes.in_both(run.lanes.part).without(loaded);
  const LaneSet varying = lanes.in_both(run.lanes.varying).without(part).without(loaded);
  run.kernels.free(run.state, lanes.without(loaded).without(part).without(varying), false);
  if (!varying.empty()) run.kernels.free(run.state, varying, true);
  move_free_part(run, part);
  if (!loaded.empty()) move_loaded_free(run, loaded);
}

void set_motion(RunningBatch& run, int lane) {
  LaneStates& lanes = run.lanes;
  switch (run.trial_of(lane).motion) {
    case LaneMotion::elements:
      lanes.elements.insert(lane);
      return lanes.bristles.insert(lane);
    case LaneMotion::bristle:
      return lanes.bristles.insert(lane);
    case LaneMotion::free:
      return lanes.free.insert(lane);
    case LaneMotion::coulomb:
    case LaneMotion::contact:
      break;
  }
  const bool slides = run.state.motion.slide_direction[lane] != 0.0;
  if (run.trial_of(lane).motion == LaneMotion::coulomb) {
    (slides ? lanes.standing : lanes.sliding).erase(lane);
    return (slides ? lanes.sliding : lanes.standing).insert(lane);
  }
  lanes.waiting.erase(lane);
  (slides ? lanes.sticking : lanes.sliding).erase(lane);
  (slides ? lanes.sliding : lanes.sticking).insert(lane);
}

}  // namespace zerocount::batch
