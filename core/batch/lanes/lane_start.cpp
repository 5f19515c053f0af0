// Start of the trials and moves of lanes.
#include <algorithm>
#include <limits>

#include "core/batch/lanes/running_batch.hpp"
#include "core/friction/bristles/bristle.hpp"
#include "core/friction/bristles/gms.hpp"
#include "core/friction/sliding/none.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/controller/disturbance_observer.hpp"
#include "core/loop/controller/pid.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/drive.hpp"
#include "core/loop/encoder.hpp"
#include "core/loop/measurement.hpp"
#include "core/trial/machine.hpp"
#include "core/trial/move_measures.hpp"

namespace zerocount::batch {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The counts of the fine encoder before the first sample of the trial. The fine encoder closes every loop
/// that the kernels run.
loop::CountsBefore counts_before(const trial::TrialParameters& p) {
  const loop::StartOfMotion start = trial::start_of_motion(p);
  return {loop::fine_encoder(p.encoder, start.phase), start.theta, start.velocity,
          1.0 / p.controller.sample_rate, 1.0};
}

void start_loop(LoopLanes& l, int lane, const trial::TrialParameters& p) {
  const loop::Encoder encoder = loop::fine_encoder(p.encoder, p.initial.encoder_phase);
  l.resolution[lane] = encoder.resolution;
  l.phase[lane] = encoder.phase;
  l.kp[lane] = p.controller.kp;
  l.ki[lane] = p.controller.ki;
  l.kd[lane] = p.controller.kd;
  const loop::TorqueRange range =
      loop::integral_range(p.controller.anti_windup, loop::lowest_torque(p.dac), loop::highest_torque(p.dac));
  l.lowest_integral[lane] = range.lowest;
  l.highest_integral[lane] = range.highest;
  l.dac_resolution[lane] = p.dac.resolution;
  l.lowest_code[lane] = static_cast<double>(loop::lowest_code(p.dac));
  l.highest_code[lane] = static_cast<double>(loop::highest_code(p.dac));
  l.integral[lane] = trial::initial_integral(p);
  l.error[lane] = 0.0;
  l.count[lane] = -loop::counted_since(counts_before(p), 1);
  const bool is_open = !p.command.torque.levels.empty();
  l.quiet_from[lane] = is_open ? -infinity : 0.0;
  l.quiet_to[lane] = is_open ? infinity : 1.0;
  l.counted[lane] = 0.0;
  l.decided[lane] = 0.0;
  l.code[lane] = 0.0;
  l.steady[lane] = 0.0;
  l.driven[lane] = needs_lane_drive(p) && !needs_drive_kernel(p) ? 1.0 : 0.0;
  l.disturbance[lane] = p.disturbance.torque;
  l.read_twist[lane] = 0.0;
}

/// Stores a whole number as two 32-bit words, each an exact double.
void store_words(std::uint64_t number, double& low, double& high) {
  low = static_cast<double>(static_cast<std::uint32_t>(number));
  high = static_cast<double>(number >> 32);
}

void start_noise(NoiseLanes& n, int lane, const trial::TrialParameters& p) {
  store_random(n.random, lane, p.randomness, p.randomness.fine_noise);
  store_constants(n.constants, lane,
                  loop::noise_constants(p.encoder.fine_errors, 1.0 / p.controller.sample_rate));
  n.sample[lane] = 0.0;
  n.state[lane] = 0.0;
  n.coarse_resolution[lane] = loop::coarse_resolution(p.encoder);
}

bool is_cascade(loop::ControlStructure structure) {
  switch (structure) {
    case loop::ControlStructure::pid:
      return false;
    case loop::ControlStructure::cascade:
      return true;
  }
  return false;
}

void start_blocks(BlockLanes& b, int lane, const trial::TrialParameters& p, double resolution) {
  const loop::ControllerParameters& controller = p.controller;
  const loop::ControlBlocks& blocks = controller.blocks;
  const double sample_rate = controller.sample_rate;
  for_each_quantity(b, [&](Lanes& quantity) { quantity[lane] = 0.0; });  // as all states start
  store_constants(
      b.integral, lane,
      loop::integral_constants(blocks, sample_rate,
                               loop::integral_range(controller.anti_windup, loop::lowest_torque(p.dac),
                                                    loop::highest_torque(p.dac))));
  b.is_cascade[lane] = is_cascade(blocks.structure) ? 1.0 : 0.0;
  store_constants(b.cascade, lane,
                  loop::cascade_constants(blocks.cascade, sample_rate, resolution, resolution));
  b.pole[lane] = loop::derivative_pole(blocks, sample_rate);
  b.filter_count[lane] = static_cast<double>(blocks.filters.size());
  for (std::size_t i = 0; i < max_lane_filters; ++i) {
    store_constants(b.filters[i], lane,
                    i < blocks.filters.size() ? loop::discretised(blocks.filters[i], sample_rate)
                                              : loop::BiquadConstants<double>{1.0, 0.0, 0.0, 0.0, 0.0});
  }
  b.observes[lane] = blocks.observer.bandwidth > 0.0 ? 1.0 : 0.0;
  const loop::ObserverConstants<double> observer =
      loop::observer_constants(blocks.observer, sample_rate, resolution);
  store_constants(b.observer, lane, observer);
  store_constants(b.observer_state, lane, loop::observer_state_after(observer, counts_before(p)));
  b.difference[lane] = loop::counts_per_sample(counts_before(p));
  store_constants(b.deadband, lane, loop::error_deadband_constants(blocks.error_deadband));
  store_constants(b.standstill, lane, loop::standstill_constants(blocks.standstill, sample_rate));
  store_constants(b.hold, lane, loop::hold_constants(blocks.hold, sample_rate));
  b.dither_amplitude[lane] = controller.dither.amplitude;
  b.dither_frequency[lane] = controller.dither.frequency;
  b.sigma_delta[lane] = p.dac.sigma_delta ? 1.0 : 0.0;
  b.remembers[lane] = remembers(p) ? 1.0 : 0.0;
}

void start_time(TimeLanes& time, int lane, const trial::TrialParameters& p, double resolution) {
  time.time_to_stop[lane] = 0.0;
  time.samples_to_stop[lane] = 1.0;
  time.sample_rate[lane] = p.controller.sample_rate;
  time.sample_time[lane] = 1.0 / p.controller.sample_rate;
  time.next_step[lane] = time.sample_time[lane];
  time.steps[lane] = 0.0;
  time.rest[lane] = trial::motion_tolerance(resolution).rest;
  time.per_count[lane] = 1.0 / resolution;
}

/// Sets the start of motion of a lane whose friction law has no hook. Such laws move θ itself and read the
/// count at each sample, as a sliding hook does.
void start_without_hook(BatchState& batch, int lane, double velocity) {
  MotionLanes& m = batch.motion;
  m.slide_direction[lane] = 1.0;
  m.theta[lane] = 0.0;
  m.omega[lane] = velocity;
  m.extension[lane] = 0.0;
  m.hardening[lane] = 0.0;
}

void start_bristle(BatchState& batch, int lane, const trial::TrialParameters& trial, double resolution) {
  const motion::PlantStart start = trial::plant_start(trial);
  const friction::BristleParameters p =
      friction::traits_of(trial.friction.model)
          .bristle(trial.plant, friction::friction_at(trial.friction, start.position));
  const motion::MotionTolerance tolerance = trial::motion_tolerance(resolution);
  const friction::Bristle bristle(p, trial.plant.inertia, start, tolerance);
  start_without_hook(batch, lane, bristle.omega());
  batch.motion.elongation[lane] = bristle.deflection();
  batch.motion.gradual_slide[lane] = bristle.sliding() ? 1.0 : 0.0;
  ContactLanes& c = batch.contact;
  c.bristle_stiffness[lane] = p.stiffness;
  c.bristle_damping[lane] = p.bristle_damping;
  c.sliding_damping[lane] = p.damping;
  c.coulomb[lane] = p.level.coulomb;
  c.breakaway[lane] = p.level.coulomb + p.level.excess;
  const bool constant = p.level.excess == 0.0;
  c.per_velocity_squared[lane] = constant ? 1.0 : p.level.per_velocity_squared;
  c.fast_velocity[lane] = constant ? -1.0 : p.fast;
  batch.time.tolerance[lane] = tolerance.elongation;
}

void start_elements(BatchState& batch, int lane, const trial::TrialParameters& trial, double resolution) {
  const motion::PlantStart start = trial::plant_start(trial);
  const motion::MotionTolerance tolerance = trial::motion_tolerance(resolution);
  const friction::GmsFriction gms(trial.plant, trial.friction, start, tolerance);
  start_without_hook(batch, lane, gms.omega());
  batch.motion.gradual_slide[lane] = gms.sliding() ? 1.0 : 0.0;
  batch.motion.rest_torque[lane] = std::numeric_limits<double>::quiet_NaN();
  ElementLanes& e = batch.elements;
  for_each_quantity(e, [lane](Lanes& quantity) { quantity[lane] = 0.0; });
  e.softest[lane] = infinity;
  for (const friction::GmsState& state : gms.elements()) {
    const auto i = static_cast<std::size_t>(e.count[lane]++);
    e.torque[i][lane] = state.torque;
    e.slips[i][lane] = state.slips ? 1.0 : 0.0;
    e.stiffness[i][lane] = state.stiffness;
    e.weight[i][lane] = state.weight;
    e.stiffest[lane] = std::max(e.stiffest[lane], state.stiffness);
    e.softest[lane] = std::min(e.softest[lane], state.stiffness);
  }
  const friction::FrictionParameters contact = friction::friction_at(trial.friction, start.position);
  e.attraction[lane] = contact.gms_attraction;
  const friction::StribeckCurve level = friction::stribeck_curve(contact);
  ContactLanes& c = batch.contact;
  c.coulomb[lane] = level.coulomb;
  c.breakaway[lane] = level.coulomb + level.excess;
  // A constant level bounds no step.
  c.per_velocity_squared[lane] = level.excess == 0.0 ? 1e-300 : level.per_velocity_squared;
  batch.time.tolerance[lane] = tolerance.elongation;
}

void start_free(BatchState& batch, int lane, const trial::TrialParameters& p, double sample_time) {
  start_without_hook(batch, lane, p.initial.velocity);
  const friction::FreeMotion by_velocity =
      friction::free_motion(p.plant, {0.0, 1.0}, motion::constant_torque(0.0), sample_time);
  const friction::FreeMotion by_torque =
      friction::free_motion(p.plant, {}, motion::constant_torque(1.0), sample_time);
  batch.time.tolerance[lane] = trial::motion_tolerance(batch.loop.resolution[lane]).elongation;
  batch.free.travel[lane] = by_velocity.theta;
  batch.free.decay[lane] = by_velocity.omega;
  batch.free.push[lane] = by_torque.theta;
  batch.free.gain[lane] = by_torque.omega;
  const friction::FreeMotion by_lag =
      friction::free_motion(p.plant, {}, {1.0, 0.0, loop::lag_rate(p.amplifier)}, sample_time);
  batch.free.lag_push[lane] = by_lag.theta;
  batch.free.lag_gain[lane] = by_lag.omega;
}

void start_load(LoadLanes& load, int lane, const trial::TrialParameters& p) {
  const motion::LoadParameters& of = p.plant.load;
  load.inertia[lane] = of.inertia;
  load.per_inertia[lane] = 1.0 / of.inertia;
  load.stiffness[lane] = of.stiffness;
  load.damping[lane] = of.damping;
  load.torque_by_velocity[lane] = motion::torque_by_velocity(of, p.plant.inertia);
  load.reads[lane] = of.encoder == motion::EncoderPlace::load ? 1.0 : 0.0;
  load.twist[lane] = 0.0;
  load.omega[lane] = p.initial.velocity;
}

void start_motion(BatchState& batch, int lane, LaneTrial& trial, double resolution) {
  const trial::TrialParameters& p = *trial.parameters;
  const motion::MotionTolerance tolerance = trial::motion_tolerance(resolution);
  trial.motion = lane_motion(p.friction.model).value();
  switch (trial.motion) {
    case LaneMotion::contact:
      trial.plant.emplace(p.plant, p.friction, trial::plant_start(p), tolerance);
      store_contact(batch, lane, trial);
      return;
    case LaneMotion::coulomb:
      start_coulomb(batch, lane, trial);
      return;
    case LaneMotion::bristle:
      start_bristle(batch, lane, p, resolution);
      return;
    case LaneMotion::elements:
      start_elements(batch, lane, p, resolution);
      return;
    case LaneMotion::free:
      start_free(batch, lane, p, batch.time.sample_time[lane]);
      return;
  }
}

}  // namespace

void store_random(RandomLanes& to, int lane, const random::TrialRandomness& of,
                  const random::RandomKey& key) {
  store_words(of.trial, to.trial_low[lane], to.trial_high[lane]);
  to.stream[lane] = of.stream;
  for (std::size_t i = 0; i < std::size(to.key); ++i) to.key[i][lane] = key[i];
}

void start_trial(BatchState& batch, int lane, LaneTrial& trial) {
  const trial::TrialParameters& p = *trial.parameters;
  trial.move = 0;
  trial.first_sample = 0;
  trial.reported_jerks = 0;
  trial.read_twist = 0.0;
  trial.breakaway_spring_torque = 0.0;
  forget_ahead(batch, lane, trial);

  start_loop(batch.loop, lane, p);
  const double resolution = batch.loop.resolution[lane];
  if (needs_lane_noise(p)) start_noise(batch.noise, lane, p);
  if (has_blocks(p)) start_blocks(batch.blocks, lane, p, resolution);
  start_time(batch.time, lane, p, resolution);
  trial.elongation_tolerance = trial::motion_tolerance(resolution).elongation;
  batch.contact.inertia[lane] = p.plant.inertia;
  batch.contact.per_inertia[lane] = 1.0 / p.plant.inertia;
  batch.contact.damping[lane] = p.plant.presliding_damping;
  batch.contact.sliding_damping[lane] = p.plant.sliding_damping;
  if (motion::has_load(p.plant)) start_load(batch.load, lane, p);
  start_motion(batch, lane, trial, resolution);
  trial.loop.reset();
  trial.position.reset();
  if (needs_lane_loop(p)) {
    trial.loop.emplace(p);
  } else if (p.verdict.position_error) {
    trial.position.emplace(p, resolution);
  }
  trial.drive.reset();
  if (needs_lane_drive(p)) start_drive(batch, lane, trial);
  start_move(batch, lane, trial);
}

void start_slides(const BatchState& batch, int lane, LaneTrial& trial) {
  trial.breakaways = 0;
  const bool has_contact = trial.motion == LaneMotion::contact;
  trial.slid_at_start =
      (has_contact || trial.motion == LaneMotion::coulomb) && batch.motion.slide_direction[lane] != 0.0;
  trial.deepest = has_contact ? static_cast<std::int64_t>(trial.plant->spring().depth()) : 0;
}

void start_move(BatchState& batch, int lane, LaneTrial& trial) {
  const trial::TrialParameters& p = *trial.parameters;
  const trial::MoveTiming timing = trial::move_timing(p, trial.move);
  MeasureLanes& q = batch.measures;
  batch.noise.disagreements[lane] = 0.0;
  const std::int64_t target = trial::target_of_move(p, trial.move);
  batch.loop.target[lane] = static_cast<double>(target);
  q.limits.samples[lane] = static_cast<double>(timing.samples);
  // Without a target no event of the error is followed.
  q.limits.dwell[lane] = timing.judged ? static_cast<double>(timing.dwell) : infinity;
  q.limits.window[lane] = static_cast<double>(timing.window);
  q.last_half[lane] =
      timing.judged ? static_cast<double>(trial::first_of_last_half(timing.samples)) : infinity;
  trial::for_each_measure([lane](Lanes& measure) { measure[lane] = 0.0; }, q);
  for (std::size_t b = 0; b < std::size(q.bands); ++b) {
    BandLanes& band = q.bands[b];
    band.limit[lane] =
        timing.judged && b < timing.bands.count ? static_cast<double>(timing.bands.limits[b]) : infinity;
    band.last_outside[lane] = trial::no_samples_of_band.last_outside;
    band.entry[lane] = trial::no_samples_of_band.entry;
    band.exits[lane] = trial::no_samples_of_band.exits;
  }
  for (Lanes* of : {&q.in_jerk, &q.change, &q.first_error, &q.theta, &q.extension, &q.slid})
    (*of)[lane] = 0.0;
  q.max_error[lane] = p.verdict.stop && timing.judged ? p.verdict.limit : infinity;
  if (trial.drive) batch.course.move_start[lane] = static_cast<double>(trial.first_sample);
  if (trial.loop) trial.loop->start_move(trial.move, target, trial.first_sample);
  if (trial.position) trial.position->start_move(trial.move);
  start_slides(batch, lane, trial);
  trial.jerks = trial::Jerks(static_cast<std::int64_t>(trial.move), timing.sample_time);
  trial.last_half.start(timing.samples);
}

void start_next_trial(RunningBatch& run, int lane) {
  LaneTrial& trial = run.trial_of(lane);
  for (LaneSet* of : run.lanes.all()) of->erase(lane);
  while (run.next_trial < run.outcomes.size()) {
    trial.number = run.next_trial++;
    trial.parameters = &(*run.source)(trial.number, run.trial_index[lane]);
    trial.outcome = &run.outcomes[trial.number];
    if (!runs_in_lanes(*trial.parameters)) {
      run_scalar(run, trial, 0, 0);
      continue;
    }
    trial.outcome->moves.clear();
    trial.outcome->moves.reserve(trial::move_count(*trial.parameters));
    start_trial(run.state, lane, trial);
    run.lanes.active.insert(lane);
    if (trial.loop) {
      run.lanes.with_loop.insert(lane);
    } else if (has_blocks(*trial.parameters)) {
      run.lanes.with_blocks.insert(lane);
    }
    if (needs_lane_noise(*trial.parameters)) run.lanes.noisy.insert(lane);
    if (needs_drive_kernel(*trial.parameters)) run.lanes.amplified.insert(lane);
    if (trial.position) run.lanes.with_position.insert(lane);
    if (motion::has_load(trial.parameters->plant)) {
      run.lanes.loaded.insert(lane);
      if (trial.drive && trial.drive->may_vary()) run.lanes.loaded_driven.insert(lane);
    }
    set_motion(run, lane);
    if (trial.drive && trial.drive->vibration_terms() > 0) run.lanes.vibrating.insert(lane);
    if (trial.drive && trial.drive->jitters()) {
      begin_piece(run, lane);
      run.lanes.before_start.insert(lane);
    }
    return;
  }
}

}  // namespace zerocount::batch
