#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/batch/batch_state.hpp"
#include "core/batch/lane_drive.hpp"
#include "core/batch/lane_loop.hpp"
#include "core/plant/plant.hpp"
#include "core/trial/jerks.hpp"
#include "core/trial/last_half.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::batch {

/// The scalar plant of a lane with a hook.
using LanePlant = plant::PlantWith<friction::PreslidingFriction>;

/// How the kernels move a lane, by its friction law.
enum class LaneMotion { contact, bristle, free };

/// Empty for a law that the kernels lack.
std::optional<LaneMotion> lane_motion(friction::FrictionModel model);

/// The motion of a lane that creeps at rest and is sampled all the time, over some samples ahead and without
/// its residual oscillation. Its plant stands where they begin.
struct CreepAhead {
  double elapsed{0.0};                 ///< time since its begin, by which the plant lags behind the lane, s
  double duration{0.0};                ///< s; 0: none
  std::array<double, 4> elongation{};  ///< coefficients in elapsed/duration, rad; so the others
  std::array<double, 4> extension{};
  std::array<double, 4> hardening{};
  int samples{0};     ///< taken one by one since the lane came to rest
  double span{16.0};  ///< samples to describe next time
};

/// State of a lane that the kernels do not use: its trial, the memory of the spring, measures per jerk.
struct LaneTrial {
  const trial::TrialParameters* parameters{nullptr};
  std::size_t number{0};  ///< of the trial in the batch
  trial::TrialOutcome* outcome{nullptr};
  std::size_t move{0};
  std::int64_t first_sample{0};  ///< of the move, from the start of the trial
  LaneMotion motion{LaneMotion::contact};

  /// The contact, in lanes with LaneMotion::contact. Only its spring is always current; call load_motion()
  /// before reading anything else.
  std::optional<LanePlant> plant;
  CreepAhead ahead;
  double elongation_tolerance{0.0};     ///< MotionTolerance::elongation, rad
  double breakaway_spring_torque{0.0};  ///< σb of the slide, N m

  std::int64_t breakaways{0};  ///< in this move
  bool slid_at_start{false};   ///< of this move
  std::int64_t deepest{0};     ///< in this move

  trial::Jerks jerks;              ///< of this move
  std::int64_t reported_jerks{0};  ///< of the trial
  trial::LastHalf last_half;       ///< of this move

  std::optional<LaneLoop> loop;  ///< of a trial that needs one

  std::optional<LaneDrive> drive;  ///< of a trial that needs one
};

/// Copies the lane's motion from the batch state into its plant.
void load_motion(const BatchState& batch, int lane, LaneTrial& trial);
/// Copies the plant's motion and spring branch into the batch state.
void store_motion(BatchState& batch, int lane, LaneTrial& trial);
/// store_motion(), and the contact's parameters, which a slide or a scalar step may have changed.
void store_contact(BatchState& batch, int lane, LaneTrial& trial);

// Changes of the contact, as PreslidingFriction makes them.
void turn(BatchState& batch, int lane, LaneTrial& trial);
void close_loop(BatchState& batch, int lane, LaneTrial& trial);
void end_creep(BatchState& batch, int lane, LaneTrial& trial);
void start_slide(BatchState& batch, int lane, LaneTrial& trial);
void end_slide(BatchState& batch, int lane, LaneTrial& trial);
/// Advances to the next stop by LanePlant::advance. @param torque on the rotor, N m, without a disturbance
/// that varies. @returns whether the motion stayed finite.
bool advance_by_reference(BatchState& batch, int lane, LaneTrial& trial, const motion::TorqueCourse& torque);

/// Sets the vibration of the lane's torque to its series about the last sample.
void store_vibration(BatchState& batch, int lane, LaneDrive& drive);
/// Sets the torque of the lane to the present piece of its drive, and its next stop to the end of that.
void start_piece(BatchState& batch, int lane, LaneTrial& trial);
/// The torque on the rotor from now on, without a disturbance that varies: of a lane whose torque varies.
motion::TorqueCourse present_course(const BatchState& batch, int lane);

/// The measures of one lane.
inline trial::RunningMeasures<double> measures_of(const MeasureLanes& lanes, int lane) {
  trial::RunningMeasures<double> measures;
  trial::for_each_measure([lane](double& to, const Lanes& from) { to = from[lane]; }, measures, lanes);
  return measures;
}

/// The measures of its error bands.
inline std::array<trial::BandMeasures<double>, trial::max_error_bands> bands_of(const MeasureLanes& lanes,
                                                                                int lane) {
  std::array<trial::BandMeasures<double>, trial::max_error_bands> bands;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const BandLanes& band = lanes.bands[b];
    bands[b] = {band.last_outside[lane], band.entry[lane], band.exits[lane]};
  }
  return bands;
}

/// Whether the controller has blocks beyond the PID law.
bool has_blocks(const trial::TrialParameters& parameters);

/// Starts the trial in the lane.
void start_trial(BatchState& batch, int lane, LaneTrial& trial, std::size_t number,
                 const trial::TrialParameters& parameters, trial::TrialOutcome& outcome);
void start_move(BatchState& batch, int lane, LaneTrial& trial);
/// The outcome of the move that ends now. @param stopped it has diverged.
trial::MoveOutcome end_of_move(const BatchState& batch, int lane, LaneTrial& trial, bool stopped);

}  // namespace zerocount::batch
