// Changes of the contact between steps.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/batch/lanes/lane_trial.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::batch {
namespace {

/// Copies the present hysteresis branch of the spring into the batch state.
void store_branch(BatchState& batch, int lane, const friction::HystereticSpring& spring) {
  MotionLanes& m = batch.motion;
  const friction::SpringBranch& branch = spring.branch();
  m.branch_elongation[lane] = branch.elongation;
  m.branch_torque[lane] = branch.torque;
  m.branch_sign[lane] = branch.sign;
  m.branch_softening_torque[lane] = branch.softening_torque;
  m.branch_softening_rate[lane] = branch.softening_rate;
  m.branch_softening_length[lane] = 1.0 / branch.softening_rate;
  m.direction[lane] = spring.direction();
  const double none = std::copysign(std::numeric_limits<double>::infinity(), spring.direction());
  m.branch_end[lane] = spring.branch_end().value_or(none);
}

/// Lower bound of the rate (1/s) at which an error of the motion decays. It is the decay rate of the slower
/// mode of J·q″ + c·q′ + k1·q = 0, because k1 is the lowest stiffness of the spring.
double error_decay(const ContactLanes& c, int lane, double k1) {
  const double gamma = 0.5 * c.damping[lane] * c.per_inertia[lane];
  const double discriminant = gamma * gamma - k1 * c.per_inertia[lane];
  return discriminant > 0.0 ? k1 * c.per_inertia[lane] / (gamma + std::sqrt(discriminant)) : gamma;
}

/// Lower bound of the rate (1/s) at which an error of the motion decays, with a load. An oscillating mode of
/// shape φ decays at the rate ½·φᵀCφ/φᵀMφ, which is at least half the lowest eigenvalue of M⁻¹C, C being the
/// damping matrix and M the mass matrix. A mode that only creeps decays at least as fast as the slower of the
/// two springs relaxes against its damper.
double error_decay(const ContactLanes& c, int lane, double k1, const motion::LoadParameters& load) {
  const double by_rotor = (c.damping[lane] + load.damping) * c.per_inertia[lane];
  const double by_load = load.damping / load.inertia;
  const double trace = by_rotor + by_load;
  const double determinant = c.damping[lane] * c.per_inertia[lane] * by_load;
  if (!(trace > 0.0)) return 0.0;
  const double oscillating =
      determinant / (trace + std::sqrt(std::max(trace * trace - 4.0 * determinant, 0.0)));
  const double creeping = std::min(k1 / c.damping[lane], load.stiffness / load.damping);
  return std::min(oscillating, creeping);
}

/// Truncation error (rad) allowed per torque step, so that the errors of all steps add up to about 1e-7
/// count. Their sum is the error of one step divided by 1 − exp(−decay·T). The loop does not amplify them,
/// because equal counts give equal torques. The result is at least `reference` (rad), the tolerance of the
/// reference engine.
double step_tolerance(const BatchState& batch, int lane, double decay, double reference) {
  const double in_sample = decay * batch.time.sample_time[lane];
  return std::max(-1e-7 * numerics::expm1(-in_sample) * batch.loop.resolution[lane], reference);
}

void store_contact_parameters(BatchState& batch, int lane, const LaneTrial& trial) {
  const friction::FrictionParameters& contact = trial.plant->contact();
  const std::optional<motion::Load>& load = trial.plant->load();
  ContactLanes& c = batch.contact;
  const double decay =
      load ? error_decay(c, lane, contact.k1, load->parameters) : error_decay(c, lane, contact.k1);
  batch.time.tolerance[lane] = step_tolerance(batch, lane, decay, trial.elongation_tolerance);
  c.k1[lane] = contact.k1;
  c.stiffest[lane] = contact.k1 + contact.k2;
  batch.time.time_scale[lane] = 1.0 / std::sqrt(c.stiffest[lane] * c.per_inertia[lane]);
  c.alpha[lane] = contact.alpha;
  c.max_creep_ratio[lane] = 8.0 * contact.alpha * c.damping[lane] / contact.k1;
  c.per_lambda[lane] = 1.0 / contact.lambda;
  c.creep_exponent[lane] = contact.n;
  store_level(batch, lane, contact);
  c.max_oscillation[lane] = std::max(batch.time.rest[lane], std::sqrt(batch.time.rest[lane] / contact.beta));
}

void remember_depth(LaneTrial& trial) {
  trial.deepest = std::max(trial.deepest, static_cast<std::int64_t>(trial.plant->spring().depth()));
}

/// Copies the state of the second mass, if there is one, from the batch state into `load`.
void load_second_mass(const BatchState& batch, int lane, std::optional<motion::Load>& load) {
  if (!load) return;
  load->twist = batch.load.twist[lane];
  load->omega = batch.load.omega[lane];
}

/// Advances the scalar plant, which must be up to date, to the lane's next stop.
template <class Plant>
void advance(BatchState& batch, int lane, LaneTrial& trial, Plant& plant,
             const motion::TorqueCourse& torque) {
  const std::int64_t before = plant.breakaways();
  if (trial.drive) plant.set_time(time_of(batch, lane, trial));
  plant.advance(torque, batch.time.time_to_stop[lane], plant::max_steps_of_sample);
  trial.breakaways += plant.breakaways() - before;
  batch.time.next_step[lane] = batch.time.sample_time[lane];
  batch.time.time_to_stop[lane] = 0.0;
}

}  // namespace

void store_level(BatchState& batch, int lane, const friction::FrictionParameters& contact) {
  ContactLanes& c = batch.contact;
  c.breakaway[lane] = contact.breakaway;
  c.coulomb[lane] = contact.coulomb_ratio * contact.breakaway;
  c.fast_velocity[lane] = friction::fast_by_stribeck_velocity * contact.stribeck_velocity;
  c.per_velocity_squared[lane] = 1.0 / (contact.stribeck_velocity * contact.stribeck_velocity);
}

void stop_at_next_sample(BatchState& batch, int lane) {
  TimeLanes& time = batch.time;
  time.time_to_stop[lane] -= (time.samples_to_stop[lane] - 1.0) * time.sample_time[lane];
  time.samples_to_stop[lane] = 1.0;
}

double time_of(const BatchState& batch, int lane, const LaneTrial& trial) {
  const auto k = static_cast<double>(std::max(last_sample(batch, lane, trial), std::int64_t{0}));
  const double elapsed = batch.course.piece_end[lane] - batch.time.time_to_stop[lane];
  return k * batch.time.sample_time[lane] + elapsed;
}

void store_load(BatchState& batch, int lane, const motion::Load& load) {
  batch.load.twist[lane] = load.twist;
  batch.load.omega[lane] = load.omega;
  batch.loop.read_twist[lane] = load.twist * batch.load.reads[lane];
}

void load_motion(const BatchState& batch, int lane, LaneTrial& trial) {
  const MotionLanes& m = batch.motion;
  friction::PlantMotion motion;
  motion.elongation = m.elongation[lane];
  motion.omega = m.omega[lane];
  motion.creep = {m.extension[lane], m.hardening[lane]};
  motion.creeping = m.creeping[lane] != 0.0;
  motion.creep_onset_torque = m.creep_onset[lane];
  motion.hook = m.hook[lane];
  motion.sliding = m.slide_direction[lane] != 0.0;
  motion.slide_theta = m.theta[lane];
  motion.slide_direction = m.slide_direction[lane];
  motion.breakaway_spring_torque = trial.breakaway_spring_torque;
  trial.plant->set_motion(motion);
  load_second_mass(batch, lane, trial.plant->load());
}

void store_motion(BatchState& batch, int lane, LaneTrial& trial) {
  MotionLanes& m = batch.motion;
  const friction::PlantMotion motion = trial.plant->motion();
  m.elongation[lane] = motion.elongation;
  m.omega[lane] = motion.omega;
  m.extension[lane] = motion.creep.extension;
  m.hardening[lane] = motion.creep.hardening;
  m.creeping[lane] = motion.creeping ? 1.0 : 0.0;
  m.creep_onset[lane] = motion.creep_onset_torque;
  m.hook[lane] = motion.hook;
  m.theta[lane] = motion.slide_theta;
  m.slide_direction[lane] = motion.sliding ? motion.slide_direction : 0.0;
  m.at_reversal[lane] = 0.0;
  m.rest_torque[lane] = std::numeric_limits<double>::quiet_NaN();
  trial.breakaway_spring_torque = motion.breakaway_spring_torque;
  if (const std::optional<motion::Load>& load = trial.plant->load()) store_load(batch, lane, *load);
  store_branch(batch, lane, trial.plant->spring());
  remember_depth(trial);
}

void store_contact(BatchState& batch, int lane, LaneTrial& trial) {
  store_motion(batch, lane, trial);
  store_contact_parameters(batch, lane, trial);
}

void reverse(BatchState& batch, int lane, LaneTrial& trial) {
  MotionLanes& m = batch.motion;
  friction::HystereticSpring& spring = trial.plant->spring();
  spring.set_direction(static_cast<int>(m.heading[lane]), m.elongation[lane], m.spring_torque[lane]);
  remember_depth(trial);
  store_branch(batch, lane, spring);
  m.softness[lane] = numerics::exp(-m.branch_softening_rate[lane] *
                                   std::abs(m.elongation[lane] - m.branch_elongation[lane]));
}

void close_loop(BatchState& batch, int lane, LaneTrial& trial) {
  trial.plant->spring().move_on_branch(batch.motion.elongation[lane]);
  store_branch(batch, lane, trial.plant->spring());
}

void end_creep(BatchState& batch, int lane, LaneTrial& trial) {
  MotionLanes& m = batch.motion;
  m.creeping[lane] = 0.0;
  m.creep_onset[lane] =
      friction::creep_onset_after_end(trial.plant->contact(), m.hardening[lane] + trial.elongation_tolerance,
                                      m.spring_torque[lane], m.elongation[lane]);
}

void break_away(BatchState& batch, int lane, LaneTrial& trial) {
  stop_at_next_sample(batch, lane);
  load_motion(batch, lane, trial);
  const double motion = batch.motion.omega[lane] != 0.0
                            ? batch.motion.omega[lane]
                            : batch.motion.torque[lane] - batch.motion.spring_torque[lane];
  trial.plant->break_away(motion < 0.0 ? -1.0 : 1.0);
  ++trial.breakaways;
  store_contact(batch, lane, trial);
}

void re_stick(BatchState& batch, int lane, LaneTrial& trial) {
  if (trial.motion == LaneMotion::coulomb) {
    load_motion(batch, lane, *trial.coulomb);
    trial.coulomb->stand_still();
    return store_contact(batch, lane, *trial.coulomb);
  }
  load_motion(batch, lane, trial);
  trial.plant->re_stick();
  store_contact(batch, lane, trial);
}

bool advance_by_reference(BatchState& batch, int lane, LaneTrial& trial, const motion::TorqueCourse& torque) {
  stop_at_next_sample(batch, lane);
  if (trial.motion == LaneMotion::coulomb) {
    CoulombPlant& plant = *trial.coulomb;
    load_motion(batch, lane, plant);
    load_second_mass(batch, lane, plant.load());
    advance(batch, lane, trial, plant, torque);
    store_contact(batch, lane, plant);
    if (plant.load()) store_load(batch, lane, *plant.load());
    return plant.finite();
  }
  load_motion(batch, lane, trial);
  trial.plant->forget_deepest();
  advance(batch, lane, trial, *trial.plant, torque);
  trial.deepest = std::max(trial.deepest, trial.plant->deepest());
  store_contact(batch, lane, trial);
  if (trial.plant->rest()) {
    batch.motion.rest_torque[lane] = trial.plant->rest()->torque;
    forget_ahead(batch, lane, trial);
  }
  return trial.plant->finite();
}

}  // namespace zerocount::batch
