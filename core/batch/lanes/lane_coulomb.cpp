// Lanes with Coulomb friction alone, friction::CoulombFriction: they stand until they may break away. Their
// slides are those of the kernels, but in the sample in which they begin.
#include "core/batch/lanes/running_batch.hpp"
#include "core/trial/machine.hpp"

namespace zerocount::batch {
namespace {

/// Lets the scalar reference engine advance the lanes whose rotor the last kernel could not hold at rest.
void leave_rest(RunningBatch& run) {
  for (int i = 0; i < run.state.event_count; ++i) {
    const int lane = run.state.event_lanes[i];
    if (follow_reference(run, lane)) set_motion(run, lane);
  }
}

/// One step of lanes whose rotor stands still by Coulomb friction, with a varying torque or a second mass.
void stand_coupled(RunningBatch& run, const LaneSet& lanes) {
  for_each_lane(lanes.in_both(run.lanes.loaded), [&](int lane) { stop_at_next_sample(run.state, lane); });
  follow_torques_of(run, lanes);
  for (const auto& [forcing, some] : by_forcing(run, lanes)) {
    if (some.empty()) continue;
    run.kernels.stand_forced(run.state, some, forcing);
    leave_rest(run);
  }
}

/// Advances lanes whose rotor stands still by Coulomb friction under a constant torque: to their next stop,
/// or until the torque releases the rotor.
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
  leave_rest(run);
}

}  // namespace

void load_motion(const BatchState& batch, int lane, CoulombPlant& plant) {
  const MotionLanes& m = batch.motion;
  plant.set_motion(
      {theta_of(batch, lane), m.omega[lane], m.slide_direction[lane], batch.contact.spent[lane] != 0.0});
}

void store_contact(BatchState& batch, int lane, const CoulombPlant& plant) {
  const friction::CoulombMotion motion = plant.motion();
  MotionLanes& m = batch.motion;
  m.theta[lane] = m.hook[lane] = motion.theta;
  m.omega[lane] = motion.omega;
  m.slide_direction[lane] = motion.direction;
  batch.contact.spent[lane] = motion.spent ? 1.0 : 0.0;
  store_level(batch, lane, plant.contact());
}

void start_coulomb(BatchState& batch, int lane, LaneTrial& trial) {
  const trial::TrialParameters& p = *trial.parameters;
  const motion::MotionTolerance tolerance = trial::motion_tolerance(batch.loop.resolution[lane]);
  trial.coulomb.emplace(p.plant, p.friction, trial::plant_start(p), tolerance);
  MotionLanes& m = batch.motion;
  for (Lanes* of : {&m.elongation, &m.extension, &m.hardening}) (*of)[lane] = 0.0;
  store_contact(batch, lane, *trial.coulomb);
  batch.time.tolerance[lane] = tolerance.elongation;
}

void move_standing(RunningBatch& run) {
  if (run.lanes.standing.empty()) return;
  const LaneSet lanes = run.lanes.standing.without(run.kernels.lanes_at_stop(run.state));
  const LaneSet constant = lanes.without(run.lanes.varying).without(run.lanes.loaded);
  if (!constant.empty()) stand_under_constant_torque(run, constant);
  if (const LaneSet coupled = lanes.without(constant); !coupled.empty()) stand_coupled(run, coupled);
}

}  // namespace zerocount::batch
