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

/// Scalar plant that takes over a lane of the batch engine whose friction model has a hook (pre-sliding law).
using LanePlant = plant::PlantWith<friction::PreslidingFriction>;
/// Scalar plant that takes over a lane of the batch engine with Coulomb friction alone.
using CoulombPlant = plant::PlantWith<friction::CoulombFriction>;

/// Decides how far ahead the slow motion of a lane at rest is described by polynomials (CreepAheadLanes).
struct CreepAhead {
  int samples{0};     ///< Number of samples evaluated one by one since the lane came to rest
  double span{16.0};  ///< Number of samples that the next polynomial description of the slow motion covers
};

/// State of one lane of the batch engine that the kernels do not use: its trial, the reversal points of the
/// spring, and the measures per jerk.
struct LaneTrial {
  const trial::TrialParameters* parameters{nullptr};
  std::size_t number{0};  ///< Index of the trial in the batch.
  trial::TrialOutcome* outcome{nullptr};
  std::size_t move{0};
  std::int64_t first_sample{0};  ///< Number of the present move's first sample, counted from the start of the
                                 /// < trial
  LaneMotion motion{LaneMotion::contact};

  /// Scalar plant of a lane with LaneMotion::contact. Only its spring is always up to date; call
  /// load_motion() before reading anything else.
  std::optional<LanePlant> plant;
  CreepAhead ahead;
  /// Scalar plant of a lane with LaneMotion::coulomb. Call load_motion() before reading its motion.
  std::optional<CoulombPlant> coulomb;
  double elongation_tolerance{0.0};  ///< Truncation error of the motion allowed per step
                                     /// < (MotionTolerance::elongation), rad
  double breakaway_spring_torque{
      0.0};                ///< Torque σb of the contact's spring when the present slide began, N m
  double read_twist{0.0};  ///< Rotor angle minus the encoder's angle at the last sample, if the
                           /// < encoder reads the second mass (LoopLanes::read_twist), rad

  std::int64_t breakaways{
      0};  ///< Number of times in the present move that the contact has broken away into a slide
  bool slid_at_start{false};  ///< Whether the contact was sliding when the present move began
  std::int64_t deepest{0};    ///< Largest number of reversal points on the spring's stack in the present
                              /// < move

  trial::Jerks jerks;              ///< Excursions of the error from zero after arrival, in the present move
  std::int64_t reported_jerks{0};  ///< Number of jerks of the trial that have been reported to the observer
  trial::LastHalf last_half;       ///< Motion of the count in the last half of the present move

  std::optional<LaneLoop> loop;  ///< Scalar sampled loop; only in a trial that needs_lane_loop().
  /// Measures the position error of the lane. Present only in a trial that asks for it and has no LaneLoop,
  /// which would measure it itself.
  std::optional<trial::PositionError> position;
  std::optional<LaneDrive> drive;  ///< Scalar drive; only in a trial that needs_lane_drive().
};

// The contact between batch state and plant. (contact_changes.cpp)

/// Copies the motion of lane `lane` from the batch state into the scalar plant of `trial`.
void load_motion(const BatchState& batch, int lane, LaneTrial& trial);
/// Copies motion and spring branch of the scalar plant of `trial` into the batch state.
void store_motion(BatchState& batch, int lane, LaneTrial& trial);
/// Calls store_motion(), and copies the parameters of the friction contact, which a slide or a scalar step
/// may have changed, into the batch state.
void store_contact(BatchState& batch, int lane, LaneTrial& trial);

/// Copies the sliding friction level (Stribeck curve) of a new slide into the batch state.
void store_level(BatchState& batch, int lane, const friction::FrictionParameters& contact);

/// Copies the state of the second mass into the batch state.
void store_load(BatchState& batch, int lane, const motion::Load& load);

/// The present time of a lane with a drive, s from the start of the trial.
double time_of(const BatchState& batch, int lane, const LaneTrial& trial);

/// Sets the time of the lane's next stop to its next sampling instant.
void stop_at_next_sample(BatchState& batch, int lane);

// Changes of the contact, as PreslidingFriction makes them. (contact_changes.cpp)
void reverse(BatchState& batch, int lane, LaneTrial& trial);
void close_loop(BatchState& batch, int lane, LaneTrial& trial);
void end_creep(BatchState& batch, int lane, LaneTrial& trial);
void break_away(BatchState& batch, int lane, LaneTrial& trial);
void re_stick(BatchState& batch, int lane, LaneTrial& trial);
/// Advances the lane to its next sample by its scalar plant.
/// @param torque torque on the rotor without a varying disturbance, N m.
/// @returns whether the motion stayed finite.
bool advance_by_reference(BatchState& batch, int lane, LaneTrial& trial, const motion::TorqueCourse& torque);

/// Starts the trial with the index `trial.number`, with its first move, in the lane. (lane_start.cpp)
void start_trial(BatchState& batch, int lane, LaneTrial& trial);
void start_move(BatchState& batch, int lane, LaneTrial& trial);
/// Starts counting breakaways and reversal points for the present move, at its first sample.
void start_slides(const BatchState& batch, int lane, LaneTrial& trial);

// Lanes with LaneMotion::coulomb. (lane_coulomb.cpp)
void start_coulomb(BatchState& batch, int lane, LaneTrial& trial);
void load_motion(const BatchState& batch, int lane, CoulombPlant& plant);
void store_contact(BatchState& batch, int lane, const CoulombPlant& plant);

/// Stores the key and counters of a random number stream of the trial in the lane. (lane_start.cpp)
void store_random(RandomLanes& to, int lane, const random::TrialRandomness& of, const random::RandomKey& key);

/// Starts delay, amplifier and disturbance of a trial that needs them. (lane_torque.cpp)
void start_drive(BatchState& batch, int lane, LaneTrial& trial);
/// The torque on the rotor from now on in a lane with a varying torque. It leaves out a varying disturbance.
/// (lane_torque.cpp)
motion::TorqueCourse present_course(const BatchState& batch, int lane);

/// Discards the polynomial description of the lane's slow motion ahead (CreepAheadLanes). (lane_rest.cpp)
void forget_ahead(BatchState& batch, int lane, LaneTrial& trial);
/// Advances the scalar plant of a lane at rest, which lags behind, to the present time of the lane.
/// (lane_rest.cpp)
void bring_up_to_date(BatchState& batch, int lane, LaneTrial& trial);

/// Calls `visit` with each member of a struct that consists of Lanes members only, in their order.
template <class Numbers, class Visit>
void for_each_quantity(Numbers& numbers, Visit visit) {
  constexpr std::size_t quantities = sizeof(Numbers) / sizeof(Lanes);
  static_assert(quantities * sizeof(Lanes) == sizeof(Numbers));
  auto* const first = reinterpret_cast<Lanes*>(&numbers);
  for (std::size_t i = 0; i < quantities; ++i) visit(first[i]);
}

/// Stores the members of a struct of constants, such as loop::IntegralConstants, in the same members of `to`,
/// for one lane.
template <template <class> class Struct>
void store_constants(Struct<Lanes>& to, int lane, const Struct<double>& from) {
  double fields[sizeof to / sizeof(Lanes)];
  static_assert(sizeof fields == sizeof from);
  std::memcpy(fields, &from, sizeof from);
  const double* field = fields;
  for_each_quantity(to, [&](Lanes& quantity) { quantity[lane] = *field++; });
}

/// Number of the lane's last sample, counted from the start of the trial; −1 before the first.
inline std::int64_t last_sample(const BatchState& batch, int lane, const LaneTrial& trial) {
  return trial.first_sample + static_cast<std::int64_t>(batch.measures.samples[lane]) - 1;
}

/// Angle θ of the lane's rotor, rad.
inline double theta_of(const BatchState& batch, int lane) {
  const MotionLanes& m = batch.motion;
  return m.slide_direction[lane] != 0.0 ? m.theta[lane]
                                        : m.hook[lane] + m.elongation[lane] + m.extension[lane];
}

}  // namespace zerocount::batch
