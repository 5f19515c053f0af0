// Lanes with Coulomb friction alone (friction::CoulombFriction): they stand until they break away. Their
// slides are those of the kernels, but for the first step, which leaves ω = 0.
#include <cmath>

#include "core/batch/lanes/running_batch.hpp"
#include "core/friction/sliding/sliding.hpp"
#include "core/numerics/sign.hpp"
#include "core/trial/rig.hpp"

namespace zerocount::batch {
namespace {

void store_contact_of_standing(BatchState& batch, int lane, const friction::FrictionParameters& contact) {
  ContactLanes& c = batch.contact;
  c.breakaway[lane] = contact.breakaway;
  c.coulomb[lane] = contact.coulomb_ratio * contact.breakaway;
  c.per_velocity_squared[lane] = 1.0 / (contact.stribeck_velocity * contact.stribeck_velocity);
  c.fast_velocity[lane] = friction::fast_by_stribeck_velocity * contact.stribeck_velocity;
}

friction::Slide slide_from_rest(const BatchState& batch, int lane, const LaneTrial& trial, double direction) {
  return {trial.standing, trial.parameters->plant.sliding_damping, batch.motion.hook[lane], 0.0, direction};
}

bool drives(const BatchState& batch, int lane, const LaneTrial& trial, double direction,
            const motion::TorqueCourse& torque) {
  return friction::leaves_rest(slide_from_rest(batch, lane, trial, direction),
                               trial.parameters->plant.inertia, torque);
}

/// Takes the first step of a slide under the torque, which drives it.
void begin_slide(RunningBatch& run, int lane, double direction, const motion::TorqueCourse& torque) {
  BatchState& batch = run.state;
  LaneTrial& trial = run.trial_of(lane);
  friction::Slide slide = slide_from_rest(batch, lane, trial, direction);
  ++trial.breakaways;
  const friction::SlideStep step =
      friction::slide_step(slide, trial.parameters->plant.inertia, torque, trial.elongation_tolerance,
                           batch.time.time_to_stop[lane]);
  MotionLanes& m = batch.motion;
  m.theta[lane] = slide.theta;
  m.omega[lane] = slide.omega;
  m.slide_direction[lane] = direction;
  batch.time.time_to_stop[lane] -= step.time;
  batch.time.next_step[lane] = 2.0 * step.time;
  if (step.ended) stand_still(batch, lane, trial);
  set_motion(run, lane);
}

/// Breaks away under a torque beyond that of breakaway, or stands up to the next sample where the excess is
/// too small to change ω in rounding.
void leave_rest(RunningBatch& run, int lane) {
  stop_at_next_sample(run.state, lane);
  const double torque = run.state.motion.torque[lane];
  const double direction = numerics::sign_of(torque);
  const motion::TorqueCourse course = motion::constant_torque(torque);
  if (drives(run.state, lane, run.trial_of(lane), direction, course)) {
    begin_slide(run, lane, direction, course);
  } else {
    run.state.time.time_to_stop[lane] = 0.0;
  }
}

/// The step of a standing lane under a torque that varies by the lag of the amplifier, as that of
/// CoulombFriction.
void stand_varying(RunningBatch& run, int lane) {
  BatchState& batch = run.state;
  const LaneTrial& trial = run.trial_of(lane);
  const motion::TorqueCourse torque = present_course(batch, lane);
  const double breakaway = batch.contact.breakaway[lane];
  double& time_to_stop = batch.time.time_to_stop[lane];
  const double towards = numerics::sign_of(torque.now);
  if (std::abs(torque.now) > breakaway && drives(batch, lane, trial, towards, torque))
    return begin_slide(run, lane, towards, torque);
  if (!motion::motor_is_constant(torque) && std::abs(torque.settled) > breakaway) {
    const double direction = numerics::sign_of(torque.settled);
    // Starts at the level itself, so that rounding does not decide whether it is passed.
    const motion::TorqueCourse release{direction * breakaway, torque.settled, torque.rate};
    const double waiting = motion::time_until(torque, release.now);
    if (waiting < time_to_stop && drives(batch, lane, trial, direction, release)) {
      time_to_stop -= waiting;
      return begin_slide(run, lane, direction, release);
    }
  }
  time_to_stop = 0.0;
}

/// Stands up to the next stop, or until the torque releases the rotor.
void stand_under_constant_torque(RunningBatch& run, const LaneSet& lanes) {
  BatchState& batch = run.state;
  double before[max_lanes];
  for_each_lane(lanes, [&](int lane) { before[lane] = batch.measures.samples[lane]; });
  run.kernels.stand(batch, lanes);
  if (run.observers->sample) {
    for_each_lane(lanes, [&](int lane) {
      const double passed = batch.measures.samples[lane] - before[lane];
      for (double j = 1.0; j <= passed; j += 1.0)
        report_sample_at_rest(run, lane, j - passed, batch.motion.hook[lane], {});
    });
  }
  for (int i = 0; i < batch.event_count; ++i) leave_rest(run, batch.event_lanes[i]);
}

}  // namespace

void stand_still(BatchState& batch, int lane, LaneTrial& trial) {
  MotionLanes& m = batch.motion;
  const trial::TrialParameters& p = *trial.parameters;
  trial.standing = friction::friction_at(p.friction, p.initial.position + m.theta[lane], ++trial.contacts);
  store_contact_of_standing(batch, lane, trial.standing);
  m.hook[lane] = m.theta[lane];
  m.omega[lane] = 0.0;
  m.slide_direction[lane] = 0.0;
}

void start_coulomb(BatchState& batch, int lane, LaneTrial& trial) {
  const trial::TrialParameters& p = *trial.parameters;
  const motion::PlantStart start = trial::plant_start(p);
  trial.contacts = 0;
  trial.standing = friction::friction_at(p.friction, start.position);
  store_contact_of_standing(batch, lane, trial.standing);
  MotionLanes& m = batch.motion;
  for (Lanes* of : {&m.theta, &m.hook, &m.elongation, &m.extension, &m.hardening}) (*of)[lane] = 0.0;
  m.omega[lane] = start.velocity;
  m.slide_direction[lane] = start.velocity == 0.0 ? 0.0 : numerics::sign_of(start.velocity);
  batch.time.tolerance[lane] = trial.elongation_tolerance;
}

void move_standing(RunningBatch& run) {
  if (run.lanes.standing.empty()) return;
  const LaneSet lanes = run.lanes.standing.without(run.kernels.lanes_at_stop(run.state));
  const LaneSet varying = lanes.in_both(run.lanes.varying);
  if (const LaneSet constant = lanes.without(varying); !constant.empty())
    stand_under_constant_torque(run, constant);
  for_each_lane(varying, [&](int lane) { stand_varying(run, lane); });
}

}  // namespace zerocount::batch
