// The start of a lane's trial and of its moves.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/batch/lane_trial.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/encoder.hpp"
#include "core/trial/move_measures.hpp"
#include "core/trial/rig.hpp"

namespace zerocount::batch {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void start_loop(LoopLanes& l, int lane, const TrialParameters& p) {
  const Encoder encoder = fine_encoder(p.encoder, p.initial.encoder_phase);
  l.resolution[lane] = encoder.resolution;
  l.phase[lane] = encoder.phase;
  l.kp[lane] = p.controller.kp;
  l.ki[lane] = p.controller.ki;
  l.kd[lane] = p.controller.kd;
  const TorqueRange range =
      integral_range(p.controller.anti_windup, lowest_torque(p.dac), highest_torque(p.dac));
  l.lowest_integral[lane] = range.lowest;
  l.highest_integral[lane] = range.highest;
  l.dac_resolution[lane] = p.dac.resolution;
  l.lowest_code[lane] = static_cast<double>(lowest_code(p.dac));
  l.highest_code[lane] = static_cast<double>(highest_code(p.dac));
  l.integral[lane] = p.initial.integral;
  l.error[lane] = 0.0;
  l.count[lane] = 0.0;
  l.counted[lane] = 0.0;
  l.decided[lane] = 0.0;
  l.code[lane] = 0.0;
  l.steady[lane] = 0.0;
  l.delay[lane] = p.controller.delay;
}

void start_time(TimeLanes& time, int lane, const TrialParameters& p, double resolution) {
  const MotionTolerance tolerance = motion_tolerance(resolution);
  time.until[lane] = 0.0;
  time.samples_left[lane] = 1.0;
  time.sample_rate[lane] = p.controller.sample_rate;
  time.sample_time[lane] = 1.0 / p.controller.sample_rate;
  time.next_step[lane] = time.sample_time[lane];
  time.steps[lane] = 0.0;
  time.tolerance[lane] = tolerance.elongation;
  time.rest[lane] = tolerance.rest;
  time.per_count[lane] = 1.0 / resolution;
}

}  // namespace

void start_trial(Tile& tile, int lane, LaneTrial& trial, std::size_t number,
                 const TrialParameters& parameters, TrialOutcome& outcome) {
  const TrialParameters& p = parameters;
  trial.parameters = &parameters;
  trial.number = number;
  trial.outcome = &outcome;
  trial.move = 0;
  trial.first_sample = 0;
  trial.told_jerks = 0;
  trial.breakaway_spring_torque = 0.0;
  trial.waiting.assign(static_cast<std::size_t>(p.controller.delay), 0.0);
  trial.oldest_waiting = 0;
  trial.waiting_alike = p.controller.delay;

  start_loop(tile.loop, lane, p);
  const double resolution = tile.loop.resolution[lane];
  start_time(tile.time, lane, p, resolution);
  trial.rest_tolerance = tile.time.tolerance[lane];
  trial.plant.emplace(p.plant, p.friction, plant_start(p), motion_tolerance(resolution));
  tile.contact.per_inertia[lane] = 1.0 / p.plant.inertia;
  tile.contact.damping[lane] = p.plant.presliding_damping;
  tile.contact.sliding_damping[lane] = p.plant.sliding_damping;
  store_motion(tile, lane, trial);
  start_move(tile, lane, trial);
}

void start_move(Tile& tile, int lane, LaneTrial& trial) {
  const TrialParameters& p = *trial.parameters;
  const MoveTiming timing = move_timing(p, trial.move);
  MeasureLanes& q = tile.measures;
  tile.loop.target[lane] = static_cast<double>(p.command.targets[trial.move]);
  q.samples[lane] = static_cast<double>(timing.samples);
  q.dwell[lane] = static_cast<double>(timing.dwell);
  q.window[lane] = static_cast<double>(timing.window);
  q.last_half[lane] = static_cast<double>(first_of_last_half(timing.samples));
  for (Lanes* measure : {&q.taken, &q.zeros_in_a_row, &q.arrived, &q.largest_since_arrival,
                         &q.largest_in_window, &q.overshoot, &q.move_direction, &q.peak_torque, &q.saturated,
                         &q.in_jerk, &q.change, &q.first_error, &q.theta, &q.extension}) {
    (*measure)[lane] = 0.0;
  }
  q.arrival[lane] = -1.0;
  q.largest_error[lane] = p.verdict.stop ? p.verdict.limit : infinity;
  trial.breakaways = 0;
  trial.slid_at_start = tile.motion.slide_direction[lane] != 0.0;
  trial.deepest = static_cast<std::int64_t>(trial.plant->spring().depth());
  trial.jerk_count = 0;
  trial.jerks_up = 0;
  trial.jerk_samples = 0;
  trial.last_half.start(timing.samples);
}

MoveOutcome outcome_of_move(const Tile& tile, int lane, LaneTrial& trial, bool stopped) {
  const MeasureLanes& q = tile.measures;
  const LoopLanes& l = tile.loop;
  const auto whole = [lane](const Lanes& of) { return static_cast<std::int64_t>(of[lane]); };
  MoveOutcome outcome;
  outcome.stopped = stopped;
  outcome.arrived = q.arrived[lane] != 0.0;
  outcome.stable = outcome.arrived && q.largest_since_arrival[lane] <= 1.0;
  outcome.broke_away = trial.slid_at_start || trial.breakaways > 0;
  outcome.saturated = q.saturated[lane] != 0.0;
  if (outcome.arrived) {
    outcome.arrival = whole(q.arrival);
    outcome.settling_time = q.arrival[lane] * tile.time.sample_time[lane];
  }
  outcome.overshoot = whole(q.overshoot);
  outcome.final_error = whole(l.error);
  outcome.final_position = q.theta[lane];
  outcome.true_error =
      true_error(whole(l.target), q.theta[lane], l.resolution[lane], trial.parameters->initial.encoder_phase);
  outcome.holding_torque = l.decided[lane];
  outcome.peak_torque = q.peak_torque[lane];
  outcome.creep = q.extension[lane];
  outcome.reversal_depth = trial.deepest;
  outcome.jerk_count = trial.jerk_count;
  if (outcome.jerk_count > 0) {
    const std::int64_t jerks_down = trial.jerk_count - trial.jerks_up;
    const std::int64_t agreeing =
        outcome.holding_torque > 0.0 ? trial.jerks_up : (outcome.holding_torque < 0.0 ? jerks_down : 0);
    outcome.jerk_agreement = static_cast<double>(agreeing) / static_cast<double>(outcome.jerk_count);
  }
  trial.last_half.finish(whole(l.count));
  judge_end(move_timing(*trial.parameters, trial.move),
            {whole(l.target), whole(q.taken), whole(q.zeros_in_a_row), trial.jerk_samples,
             whole(q.largest_in_window), true},
            trial.last_half, outcome);
  return outcome;
}

}  // namespace zerocount::batch
