// Lanes with Coulomb friction alone, friction::CoulombFriction: they stand until they break away. Their
// slides are those of the kernels, but for the first step, which leaves ω = 0.
#include <cmath>
#include <utility>

#include "core/batch/lanes/running_batch.hpp"
#include "core/friction/sliding/sliding.hpp"
#include "core/friction/sliding/standing.hpp"
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

/// Takes the first step of a slide under the torque, which drives it. @param at_level Slide::at_level.
void begin_slide(RunningBatch& run, int lane, double direction, const motion::TorqueCourse& torque,
                 bool at_level = false) {
  BatchState& batch = run.state;
  LaneTrial& trial = run.trial_of(lane);
  friction::Slide slide = slide_from_rest(batch, lane, trial, direction);
  slide.at_level = at_level;
  ++trial.breakaways;
  const friction::SlideStep step =
      friction::slide_step(slide, trial.parameters->plant.inertia, torque, trial.elongation_tolerance,
                           batch.time.time_to_stop[lane]);
  MotionLanes& m = batch.motion;
  m.theta[lane] = slide.theta;
  m.omega[lane] = slide.omega;
  m.slide_direction[lane] = direction;
  batch.time.time_to_stop[lane] -= step.time;
  batch.time.next_step[lane] = step.ended ? batch.time.sample_time[lane] : 2.0 * step.time;
  if (torque.load != nullptr) store_load(batch, lane, *torque.load);
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

/// The torque on a standing rotor from now on, with what varies of it.
class StandingTorque {
 public:
  StandingTorque(const RunningBatch& run, int lane, const LaneTrial& trial)
      : load_{trial.parameters->plant.load, run.state.load.twist[lane], run.state.load.omega[lane]},
        varying_{trial.drive ? trial.drive->disturbance() : none, 0.0, run.state.motion.hook[lane]} {
    const BatchState& batch = run.state;
    course = run.lanes.varying.contains(lane) ? present_course(batch, lane)
                                              : motion::constant_torque(batch.motion.torque[lane]);
    if (run.lanes.loaded.contains(lane)) course.load = &load_;
    if (!motion::varies(varying_.of)) return;
    varying_.time = time_of(batch, lane, trial);
    course.disturbance = &varying_;
  }
  StandingTorque(const StandingTorque&) = delete;
  StandingTorque& operator=(const StandingTorque&) = delete;

  motion::TorqueCourse course;

  /// Goes on by `time` (s); the load has moved.
  void go_on(double time) {
    course = motion::course_after(course, time);
    varying_.time += time;
  }

 private:
  static inline const motion::Disturbance none{};
  motion::Load load_;
  motion::VaryingTorque varying_;
};

/// The step of a standing lane under the lag of an amplifier alone, which is monotonic.
void stand_under_lag(RunningBatch& run, int lane, const motion::TorqueCourse& torque) {
  const double breakaway = run.state.contact.breakaway[lane];
  double& time_to_stop = run.state.time.time_to_stop[lane];
  if (!motion::motor_is_constant(torque) && std::abs(torque.settled) > breakaway) {
    const double direction = numerics::sign_of(torque.settled);
    // Starts at the level itself, so that rounding does not decide whether it is passed.
    const motion::TorqueCourse release{direction * breakaway, torque.settled, torque.rate};
    const double waiting = motion::time_until(torque, release.now);
    if (waiting < time_to_stop && drives(run.state, lane, run.trial_of(lane), direction, release)) {
      time_to_stop -= waiting;
      return begin_slide(run, lane, direction, release);
    }
  }
  time_to_stop = 0.0;
}

/// The step of a standing lane whose motor's torque alone may release it, as that of CoulombFriction.
void stand_under_motor(RunningBatch& run, int lane, const motion::TorqueCourse& torque) {
  const double towards = numerics::sign_of(torque.now);
  const bool is_beyond = std::abs(torque.now) > run.state.contact.breakaway[lane];
  if (is_beyond && drives(run.state, lane, run.trial_of(lane), towards, torque)) {
    begin_slide(run, lane, towards, torque);
  } else {
    stand_under_lag(run, lane, torque);
  }
}

/// The step of a standing lane whose torque may release it, as that of CoulombFriction.
void stand_by_reference(RunningBatch& run, int lane) {
  BatchState& batch = run.state;
  if (batch.time.steps[lane] > max_steps_to_stop) return fall_back_to_scalar(run, lane);
  const LaneTrial& trial = run.trial_of(lane);
  StandingTorque torque(run, lane, trial);
  if (!motion::is_coupled(torque.course)) return stand_under_motor(run, lane, torque.course);
  ContactLanes& c = batch.contact;
  const friction::StandingContact contact{c.breakaway[lane], c.inertia[lane],
                                          std::exchange(c.spent[lane], 0.0) != 0.0};
  double& time_to_stop = batch.time.time_to_stop[lane];
  const friction::StandStep step =
      friction::stand_step(contact, torque.course, trial.elongation_tolerance, time_to_stop);
  if (torque.course.load != nullptr) store_load(batch, lane, *torque.course.load);
  time_to_stop = step.time < time_to_stop ? time_to_stop - step.time : 0.0;
  torque.go_on(step.time);
  if (step.direction != 0.0) begin_slide(run, lane, step.direction, torque.course, step.at_level);
}

/// Stands for a step under torques that vary, or with a second mass.
void stand_coupled(RunningBatch& run, const LaneSet& lanes) {
  for_each_lane(lanes.in_both(run.lanes.loaded), [&](int lane) { stop_at_next_sample(run.state, lane); });
  follow_torques_of(run, lanes);
  for (const auto& [forcing, some] : by_forcing(run, lanes)) {
    if (some.empty()) continue;
    run.kernels.stand_forced(run.state, some, forcing);
    for (int i = 0; i < run.state.event_count; ++i) stand_by_reference(run, run.state.event_lanes[i]);
  }
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
  batch.contact.spent[lane] =
      friction::leads_nowhere(m.hook[lane], m.theta[lane], trial.elongation_tolerance) ? 1.0 : 0.0;
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
  batch.contact.spent[lane] = 0.0;
  batch.time.tolerance[lane] = trial.elongation_tolerance;
}

void move_standing(RunningBatch& run) {
  if (run.lanes.standing.empty()) return;
  const LaneSet lanes = run.lanes.standing.without(run.kernels.lanes_at_stop(run.state));
  const LaneSet constant = lanes.without(run.lanes.varying).without(run.lanes.loaded);
  if (!constant.empty()) stand_under_constant_torque(run, constant);
  if (const LaneSet coupled = lanes.without(constant); !coupled.empty()) stand_coupled(run, coupled);
}

}  // namespace zerocount::batch
