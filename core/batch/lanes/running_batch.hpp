#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/batch/batch.hpp"
#include "core/batch/kernels/kernels.hpp"
#include "core/batch/lanes/lane_trial.hpp"

namespace zerocount::batch {

/// Sets of lanes of the batch engine, by the state of their trials.
struct LaneStates {
  LaneSet active;  ///< Lanes that run a trial

  // Motion: each active lane is in one of these.
  LaneSet sticking;  ///< Lanes whose friction contact sticks and acts as a spring
  LaneSet waiting;   ///< Lanes whose friction contact sticks, with an event in the next step. The event is
                     /// < located once enough lanes wait.
  LaneSet standing;  ///< Lanes whose rotor is held still by Coulomb friction
  LaneSet sliding;   ///< Lanes whose friction contact slides, by the pre-sliding law or by Coulomb friction
  LaneSet bristles;  ///< Lanes whose friction law has a bristle or Maxwell-slip elements
  LaneSet elements;  ///< Subset of `bristles`: lanes with Maxwell-slip elements
  LaneSet free;      ///< Lanes without friction.

  // Decision at a sample: the PID law alone, if in neither.
  LaneSet with_blocks;  ///< Lanes whose controller has blocks beyond the PID law
  LaneSet with_loop;    ///< Lanes whose torque a scalar LaneLoop decides

  LaneSet noisy;  ///< Lanes whose encoder has noise that the kernels simulate

  LaneSet with_position;  ///< Lanes whose position error is measured here, not by a LaneLoop

  LaneSet amplified;     ///< Lanes whose decided torque passes through the drive kernel (delay and amplifier)
  LaneSet vibrating;     ///< Lanes with a vibration torque that is given as a Taylor series
  LaneSet before_start;  ///< Lanes whose first sample is late and has not been taken yet

  // Torque until the next stop: constant for a whole sample, if in none.
  LaneSet varying;   ///< Lanes whose torque varies until their next stop
  LaneSet part;      ///< Lanes whose present piece of torque does not last exactly one sample time
  LaneSet changing;  ///< Lanes whose next stop lies between two samples, where their torque changes

  LaneSet loaded;  ///< Lanes with a second mass.
  /// Subset of `loaded` whose torque may vary. Their integration steps always use CourseLanes.
  LaneSet loaded_driven;

  LaneSet ahead;  ///< Lanes at rest that follow a polynomial description of their slow motion
                  /// < (CreepAheadLanes); their scalar plant lags behind

  std::array<LaneSet*, 21> all() {
    return {&active,       &sticking,    &waiting,   &standing, &sliding,       &bristles,      &elements,
            &free,         &with_blocks, &with_loop, &noisy,    &with_position, &amplified,     &vibrating,
            &before_start, &varying,     &part,      &changing, &loaded,        &loaded_driven, &ahead};
  }
};

/// A batch of trials while it runs: the trials in the lanes, and the trials that remain to be started.
struct RunningBatch {
  explicit RunningBatch(const BatchSettings& settings);

  LaneTrial& trial_of(int lane) { return trials[trial_index[lane]]; }
  /// Number of samples of the lane's present move so far.
  std::int64_t samples_of(int lane) const { return static_cast<std::int64_t>(state.measures.samples[lane]); }

  const Kernels& kernels;
  std::vector<LaneTrial> trials;         ///< States of the trials in the lanes, one per lane
  std::size_t trial_index[max_lanes]{};  ///< Index in `trials` of the trial in each lane.
  BatchState state{};                    ///< State of all lanes as the kernels use it
  PassedSamples passed_samples[max_lanes]{};
  LaneStates lanes;

  const TrialSource* source{nullptr};
  std::span<trial::TrialOutcome> outcomes;
  const BatchObservers* observers{nullptr};
  std::size_t next_trial{0};  ///< Index in the batch of the next trial to start
  std::int64_t rounds{0};
  int used_lanes{0};  ///< Number of lanes in use; lanes from this index on are idle
};

// The life of a lane. BatchEngine::run() calls the stages in this order; each takes all lanes that are due.
//
//   start_next_trial
//   for each move
//     for each sample
//       take_samples             encoders → controller → converter → measures
//                                a lane that diverges: stop_diverged, start_next_trial
//       until the next sample    (change_torques where the torque changes before it)
//         move_sticking          one step; first end_creep, come_to_rest, break_away or reverse,
//                                then close_loop, creep on, end_creep or break_away
//         or move_sliding        one step; then re_stick
//         or move_standing, move_bristles, move_free
//     end_moves                  the outcome of the move
//   start_next_trial

/// Starts in this lane the next trial that lanes can run, if any is left. Runs the trials before it that
/// lanes cannot run with run_trial(). (lane_start.cpp)
void start_next_trial(RunningBatch& run, int lane);

/// Begins the next piece of the motor's torque in the lanes that have stopped within a sample time.
/// (lane_torque.cpp)
void change_torques(RunningBatch& run);

/// Ends the moves whose samples have all been taken; their lanes go on to the next move or trial.
/// @returns the lanes that are at a sampling instant. (lane_end.cpp)
LaneSet end_moves(RunningBatch& run);

/// Processes one sampling instant of the lanes `due`: encoders, controller, converter, and measures. A lane
/// whose move diverges goes on to the next trial. (lane_samples.cpp)
void take_samples(RunningBatch& run, const LaneSet& due);

// One step of each lane that is between two stops: to its next stop, or to an event before it.
// (lane_steps.cpp)
void move_sticking(RunningBatch& run);
void move_sliding(RunningBatch& run);
void move_standing(RunningBatch& run);  // (lane_coulomb.cpp)
void move_bristles(RunningBatch& run);
void move_free(RunningBatch& run);

// Parts of the stages.

/// Inserts the lane, which has a trial, into the set of LaneStates that matches its state of motion.
/// (lane_steps.cpp)
void set_motion(RunningBatch& run, int lane);

/// Advances the lane to its next sample by its scalar plant. If the motion does not stay finite, the whole
/// trial is run anew by run_trial().
/// @returns whether the motion stayed finite. (lane_steps.cpp)
bool follow_reference(RunningBatch& run, int lane);

/// Divides the lanes into four sets by whether their torque varies and whether they have a second mass.
/// (lane_steps.cpp)
std::array<std::pair<Forcing, LaneSet>, 4> by_forcing(const RunningBatch& run, const LaneSet& lanes);
/// Computes the varying torques of these lanes and their Taylor series, for the next steps. (lane_steps.cpp)
void follow_torques_of(RunningBatch& run, const LaneSet& lanes);

/// Passes the torques decided at this sample through the drive kernel (delay and amplifier).
/// (lane_torque.cpp)
void amplify(RunningBatch& run, const LaneSet& lanes);
/// Makes the present piece of the LaneDrive's torque the torque of the lane. (lane_torque.cpp)
void begin_piece(RunningBatch& run, int lane);
/// Computes the torque on the rotor by the lane's LaneDrive from the torque decided at the last sample. If it
/// does not stay constant, the lane's next stop is the end of its first piece. (lane_torque.cpp)
void drive_torque(RunningBatch& run, int lane);

/// Applies the rest rule to the lane. A lane at rest advances in closed form, by creep and residual
/// oscillation, to its next stop or to the first sampling instant at which its count differs.
/// @returns whether the lane was at rest; then it is at a stop. (lane_rest.cpp)
bool come_to_rest(RunningBatch& run, int lane);

/// Ends the lane's trial, whose move has diverged at the last sample. (lane_end.cpp)
void stop_diverged(RunningBatch& run, int lane);
/// Runs the whole trial by run_trial(). Jerks and samples already reported are not reported again.
/// (lane_end.cpp)
void run_scalar(RunningBatch& run, const LaneTrial& trial, std::int64_t reported_jerks,
                std::int64_t reported_samples);
/// Runs the lane's trial anew by run_trial(), because the kernels cannot follow its motion, or because the
/// count of its encoder has overflowed. (lane_end.cpp)
void fall_back_to_scalar(RunningBatch& run, int lane);
/// Moves trials from the last lanes to idle lanes, once no trials are left to start. Kernels are faster on
/// neighbouring lanes, which share cache lines. (lane_end.cpp)
void close_gaps(RunningBatch& run);

/// Reports the last jerk of the trial, which has ended, to the observer. (lane_records.cpp)
void report_jerk(RunningBatch& run, LaneTrial& trial);
/// Reports the lane's last sample to the observer. (lane_records.cpp)
void report_sample(RunningBatch& run, int lane);
/// Reports the samples that integration steps passed over, evaluated from their series, to the observer.
/// (lane_records.cpp)
void report_passed_samples(RunningBatch& run);
/// Reports, for each lane that stands between two samples, the last sample that it has passed over at rest to
/// the observer.
void report_passed_at_rest(RunningBatch& run, const LaneSet& lanes);
/// Reports a sample passed over at rest to the observer.
/// @param passed number of samples since the last one taken.
/// @param theta rotor angle at the sample, rad.
/// @param creep state of creep at the sample. (lane_records.cpp)
void report_sample_at_rest(RunningBatch& run, int lane, double passed, double theta,
                           const friction::CreepState& creep);

}  // namespace zerocount::batch
