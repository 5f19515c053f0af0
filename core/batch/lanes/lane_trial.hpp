#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>

#include "core/batch/kernels/batch_state.hpp"
#include "core/batch/lanes/lane_drive.hpp"
#include "core/batch/lanes/lane_loop.hpp"
#include "core/batch/lanes/lane_needs.hpp"
#include "core/plant/plant.hpp"
#include "core/trial/jerks.hpp"
#include "core/trial/last_half.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"
#include "core/trial/position_error.hpp"

namespace zerocount::batch {

/// The scalar plant of a lane with a hook.
using LanePlant = plant::PlantWith<friction::PreslidingFriction>;
/// The scalar plant of a lane with Coulomb friction alone.
using CoulombPlant = plant::PlantWith<friction::CoulombFriction>;

/// How far ahead the motion of a lane at rest is described (CreepAheadLanes).
struct CreepAhead {
  int samples{0};     ///< Samples evaluated one by one since the lane came to rest
  double span{16.0};  ///< Number of samples that the next description covers
};

/// State of a lane that the kernels do not use: its trial, the memory of the spring, measures per jerk.
struct LaneTrial {
  const trial::TrialParameters* parameters{nullptr};
  std::size_t number{0};  ///< Index of the trial in the batch.
  trial::TrialOutcome* outcome{nullptr};
  std::size_t move{0};
  std::int64_t first_sample{0};  ///< Number of the move's first sample, from the start of the trial.
  LaneMotion motion{LaneMotion::contact};

  /// The contact, in lanes with LaneMotion::contact. Only its spring is always current; call load_motion()
  /// before reading anything else.
  std::optional<LanePlant> plant;
  CreepAhead ahead;
  /// Scalar plant in lanes with LaneMotion::coulomb. Call load_motion() before reading its motion.
  std::optional<CoulombPlant> coulomb;
  double elongation_tolerance{0.0};     ///< MotionTolerance::elongation, rad
  double breakaway_spring_torque{0.0};  ///< Spring torque σb of the slide, N m
  double read_twist{0.0};               ///< LoopLanes::read_twist at the last sample, rad

  std::int64_t breakaways{0};  ///< Breakaways in the present move.
  bool slid_at_start{false};   ///< The contact slid when the present move began.
  std::int64_t deepest{0};     ///< Largest depth of the reversal stack in the present move.

  trial::Jerks jerks;              ///< Jerks of the present move.
  std::int64_t reported_jerks{0};  ///< Jerks of the trial that have been reported.
  trial::LastHalf last_half;       ///< Last half of the present move.

  std::optional<LaneLoop> loop;  ///< Scalar sampled loop; only in a trial that needs_lane_loop().
  /// Measures the position error. Only in a trial that asks for it and has no LaneLoop, which would measure
  /// it.
  std::optional<trial::PositionError> position;
  std::optional<LaneDrive> drive;  ///< Scalar drive; only in a trial that needs_lane_drive().
};

// The contact between batch state and plant. (contact_changes.cpp)

/// Copies the lane's motion from the batch state into its plant.
void load_motion(const BatchState& batch, int lane, LaneTrial& trial);
/// Copies the plant's motion and spring branch into the batch state.
void store_motion(BatchState& batch, int lane, LaneTrial& trial);
/// Calls store_motion() and copies the contact's parameters, which a slide or a scalar step may have changed.
void store_contact(BatchState& batch, int lane, LaneTrial& trial);

/// Copies the level of friction of a slide into the batch state.
void store_level(BatchState& batch, int lane, const friction::FrictionParameters& contact);

/// Copies the state of the second mass into the batch state.
void store_load(BatchState& batch, int lane, const motion::Load& load);

/// The present time of a lane with a drive, s from the start of the trial.
double time_of(const BatchState& batch, int lane, const LaneTrial& trial);

/// Makes the next sampling instant the next stop.
void stop_at_next_sample(BatchState& batch, int lane);

// Changes of the contact, as PreslidingFriction makes them. (contact_changes.cpp)
void reverse(BatchState& batch, int lane, LaneTrial& trial);
void close_loop(BatchState& batch, int lane, LaneTrial& trial);
void end_creep(BatchState& batch, int lane, LaneTrial& trial);
void break_away(BatchState& batch, int lane, LaneTrial& trial);
void re_stick(BatchState& batch, int lane, LaneTrial& trial);
/// Advances to the next sample by the lane's scalar plant. @param torque torque on the rotor, N m, without a
/// varying disturbance. @returns whether the motion stayed finite.
bool advance_by_reference(BatchState& batch, int lane, LaneTrial& trial, const motion::TorqueCourse& torque);

/// Starts the trial that `trial` names, with its first move, in the lane. (lane_start.cpp)
void start_trial(BatchState& batch, int lane, LaneTrial& trial);
void start_move(BatchState& batch, int lane, LaneTrial& trial);
/// Starts to measure slides and reversals of the move: from its first sample on.
void start_slides(const BatchState& batch, int lane, LaneTrial& trial);

// Lanes with LaneMotion::coulomb. (lane_coulomb.cpp)
void start_coulomb(BatchState& batch, int lane, LaneTrial& trial);
void load_motion(const BatchState& batch, int lane, CoulombPlant& plant);
void store_contact(BatchState& batch, int lane, const CoulombPlant& plant);

/// Stores a stream of random numbers of the trial in the lane. (lane_start.cpp)
void store_random(RandomLanes& to, int lane, const random::TrialRandomness& of, const random::RandomKey& key);

/// Starts the drive of a trial that needs one. (lane_torque.cpp)
void start_drive(BatchState& batch, int lane, LaneTrial& trial);
/// The torque on the rotor from now on in a lane with a varying torque. It leaves out a varying disturbance.
/// (lane_torque.cpp)
motion::TorqueCourse present_course(const BatchState& batch, int lane);

/// Ends the description of the lane's motion ahead. (lane_rest.cpp)
void forget_ahead(BatchState& batch, int lane, LaneTrial& trial);
/// Advances the plant of a lane at rest to where the lane is. (lane_rest.cpp)
void bring_up_to_date(BatchState& batch, int lane, LaneTrial& trial);

/// Calls `visit` with each quantity of a struct of Lanes alone, in their order.
template <class Numbers, class Visit>
void for_each_quantity(Numbers& numbers, Visit visit) {
  constexpr std::size_t quantities = sizeof(Numbers) / sizeof(Lanes);
  static_assert(quantities * sizeof(Lanes) == sizeof(Numbers));
  auto* const first = reinterpret_cast<Lanes*>(&numbers);
  for (std::size_t i = 0; i < quantities; ++i) visit(first[i]);
}

/// Stores the fields of a struct, such as loop::IntegralConstants, in the lane.
template <template <class> class Struct>
void store_constants(Struct<Lanes>& to, int lane, const Struct<double>& from) {
  double fields[sizeof to / sizeof(Lanes)];
  static_assert(sizeof fields == sizeof from);
  std::memcpy(fields, &from, sizeof from);
  const double* field = fields;
  for_each_quantity(to, [&](Lanes& quantity) { quantity[lane] = *field++; });
}

/// Number of the last sample from the start of the trial; −1 before the first.
inline std::int64_t last_sample(const BatchState& batch, int lane, const LaneTrial& trial) {
  return trial.first_sample + static_cast<std::int64_t>(batch.measures.samples[lane]) - 1;
}

/// θ of the rotor, rad.
inline double theta_of(const BatchState& batch, int lane) {
  const MotionLanes& m = batch.motion;
  return m.slide_direction[lane] != 0.0 ? m.theta[lane]
                                        : m.hook[lane] + m.elongation[lane] + m.extension[lane];
}

}  // namespace zerocount::batch
