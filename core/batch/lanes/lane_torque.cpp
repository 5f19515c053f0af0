// The torque on the rotor from sample to sample, in lanes with a LaneDrive.
#include "core/batch/lanes/running_batch.hpp"
#include "core/numerics/elementary_functions.hpp"
#include "core/trial/machine.hpp"

namespace zerocount::batch {
namespace {

/// Stores the Taylor series of the vibration torque about sample k in the lane.
void store_vibration(BatchState& batch, int lane, LaneDrive& drive, std::int64_t k) {
  const VibrationSeries::Coefficients vibration = drive.vibration(k);
  for (std::size_t j = 0; j <= drive.vibration_terms(); ++j) batch.course.vibration[j][lane] = vibration[j];
}

/// Sets the torque of the lane to the constant `torque` (N m).
void hold_torque(BatchState& batch, int lane, double torque) {
  batch.motion.torque[lane] = torque;
  batch.course.settled[lane] = torque;
  batch.course.lag[lane] = 0.0;
  batch.course.decay[lane] = 0.0;
}

/// Sets the torque of the lane to the present piece of its drive's torque, and its next stop to the end of
/// that piece.
void store_piece(BatchState& batch, int lane, const LaneDrive& drive) {
  const loop::TorquePiece& piece = drive.piece();
  CourseLanes& c = batch.course;
  const double disturbance = batch.loop.disturbance[lane];
  batch.motion.torque[lane] = piece.course.now + disturbance;
  c.settled[lane] = piece.course.settled + disturbance;
  c.lag[lane] = piece.course.now - piece.course.settled;
  c.decay[lane] = piece.course.rate;
  c.piece[lane] = piece.duration;
  c.piece_end[lane] = drive.piece_end();
  batch.time.samples_to_stop[lane] = 1.0;
  batch.time.time_to_stop[lane] = piece.duration;
}

/// Sets the initial state of delay and amplifier, as the drive kernel uses it, for the lane.
void start_drive_kernel(DriveLanes& d, int lane, const LaneTrial& trial) {
  const trial::TrialParameters& p = *trial.parameters;
  const LaneDrive& drive = *trial.drive;
  for_each_quantity(d, [lane](Lanes& quantity) { quantity[lane] = 0.0; });
  d.delay[lane] = d.alike[lane] = p.controller.delay;
  d.rate[lane] = loop::lag_rate(p.amplifier);
  const double held = trial::held_torque(p);
  d.now[lane] = d.settled[lane] = d.last[lane] = held;
  for (Lanes& waiting : d.waiting) waiting[lane] = held;
  d.decay[lane] = numerics::exp(-d.rate[lane] * (1.0 / p.controller.sample_rate));
  d.disturbed[lane] = drive.disturbance_varies() ? 1.0 : 0.0;
  const bool is_contact = trial.motion == LaneMotion::contact;
  const bool stops = drive.vibration_terms() > 0 || (!is_contact && drive.disturbance_varies());
  d.stops[lane] = stops ? 1.0 : 0.0;
  d.jitter[lane] = p.controller.jitter;
  if (!drive.jitters()) return;
  store_random(d.random, lane, p.randomness, p.randomness.jitter);
  d.late[lane] = drive.piece().duration;  // until the first sample
}

void start_lines(CourseLanes& c, int lane, const LaneDrive& drive) {
  const std::vector<motion::Vibration>& lines = drive.disturbance().vibration;
  const std::size_t count = drive.lanes_have_lines() ? lines.size() : 0;
  c.line_count[lane] = static_cast<double>(count);
  for (std::size_t i = 0; i < std::size(c.lines); ++i) {
    const motion::Vibration line = i < count ? lines[i] : motion::Vibration{};
    c.lines[i].amplitude[lane] = line.amplitude;
    c.lines[i].rate[lane] = line.rate;
    c.lines[i].phase[lane] = line.phase;
  }
}

}  // namespace

void start_drive(BatchState& batch, int lane, LaneTrial& trial) {
  LaneDrive& drive = trial.drive.emplace(*trial.parameters);
  CourseLanes& c = batch.course;
  const motion::Disturbance& varying = drive.disturbance();
  // Without a disturbance that varies the reference lets the rotor rest under a varying torque, too.
  c.tolerance[lane] = drive.disturbance_varies() ? 0.0 : trial.elongation_tolerance;
  c.vibrates[lane] = static_cast<double>(drive.vibration_terms());
  for (Lanes& coefficient : c.vibration) coefficient[lane] = 0.0;
  store_vibration(batch, lane, drive, 0);
  start_lines(c, lane, drive);
  const loop::ControllerParameters& controller = trial.parameters->controller;
  const double longest = 1.0 / controller.sample_rate + controller.jitter;
  c.left_out[lane] = motion::vibration_beyond(varying, batch_order, longest);
  if (needs_drive_kernel(*trial.parameters)) start_drive_kernel(batch.drive, lane, trial);
  c.ripple_count[lane] = static_cast<double>(varying.ripple.size());
  for (std::size_t i = 0; i < std::size(c.ripples); ++i) {
    const motion::Ripple ripple = i < varying.ripple.size() ? varying.ripple[i] : motion::Ripple{};
    RippleLanes& to = c.ripples[i];
    to.amplitude[lane] = ripple.amplitude;
    to.per_angle[lane] = ripple.per_angle;
    to.phase[lane] = ripple.phase;
    to.sine[lane] = to.cosine[lane] = 0.0;
  }
  if (trial.motion == LaneMotion::contact) trial.plant->disturb(varying);
  if (trial.motion == LaneMotion::coulomb) trial.coulomb->disturb(varying);
}

motion::TorqueCourse present_course(const BatchState& batch, int lane) {
  const CourseLanes& c = batch.course;
  const double elapsed = c.piece[lane] - batch.time.time_to_stop[lane];
  const double lag = c.lag[lane] * numerics::exp(-c.decay[lane] * elapsed);
  return {c.settled[lane] + lag, c.settled[lane], c.decay[lane]};
}

void drive_torque(RunningBatch& run, int lane) {
  LaneTrial& trial = run.trial_of(lane);
  LaneDrive& drive = *trial.drive;
  const LoopLanes& l = run.state.loop;
  const std::int64_t k = last_sample(run.state, lane, trial);
  drive.send(k, l.converted[lane]);
  if (drive.stays()) {
    run.lanes.varying.erase(lane);
    run.lanes.part.erase(lane);
    hold_torque(run.state, lane, drive.piece().course.now + l.disturbance[lane]);
    return;
  }
  if (run.state.course.vibrates[lane] != 0.0) store_vibration(run.state, lane, drive, k);
  begin_piece(run, lane);
}

void amplify(RunningBatch& run, const LaneSet& lanes) {
  const LaneSet varying = run.kernels.drive(run.state, lanes);
  for_each_lane(lanes.in_both(run.lanes.vibrating), [&](int lane) {
    LaneTrial& trial = run.trial_of(lane);
    store_vibration(run.state, lane, *trial.drive, last_sample(run.state, lane, trial));
  });
  for_each_lane(lanes.without(varying), [&](int lane) { run.lanes.varying.erase(lane); });
  for_each_lane(varying, [&](int lane) { run.lanes.varying.insert(lane); });
}

void begin_piece(RunningBatch& run, int lane) {
  const LaneDrive& drive = *run.trial_of(lane).drive;
  store_piece(run.state, lane, drive);
  LaneStates& lanes = run.lanes;
  for (LaneSet* set : {&lanes.varying, &lanes.part, &lanes.changing}) set->erase(lane);
  const loop::TorquePiece& piece = drive.piece();
  if (drive.disturbance_varies() || !motion::motor_is_constant(piece.course)) lanes.varying.insert(lane);
  if (piece.duration != run.state.time.sample_time[lane]) lanes.part.insert(lane);
  if (!drive.is_last_piece()) lanes.changing.insert(lane);
}

void change_torques(RunningBatch& run) {
  if (run.lanes.changing.empty()) return;
  for_each_lane(run.lanes.changing.in_both(run.kernels.lanes_at_stop(run.state)), [&](int lane) {
    run.trial_of(lane).drive->next_piece();
    begin_piece(run, lane);
    run.state.time.steps[lane] = 0.0;
  });
}

}  // namespace zerocount::batch
