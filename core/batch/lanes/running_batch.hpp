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

/// The lanes by their state.
struct LaneStates {
  LaneSet active;  ///< Lanes with a trial.

  // Motion: each active lane is in one of these.
  LaneSet sticking;  ///< The hook sticks.
  LaneSet waiting;  ///< The hook sticks, and an event lies in the step. It is located once enough lanes wait.
  LaneSet standing;  ///< Coulomb friction holds the rotor.
  LaneSet sliding;   ///< The hook slides, or the rotor slides against Coulomb friction.
  LaneSet bristles;  ///< The friction law has a bristle or elements.
  LaneSet elements;  ///< Subset of `bristles` with elements.
  LaneSet free;      ///< Lanes without friction.

  // Decision at a sample: the PID law alone, if in neither.
  LaneSet with_blocks;  ///< The controller has blocks.
  LaneSet with_loop;    ///< A LaneLoop decides.

  LaneSet noisy;  ///< The encoder has noise that the kernels read.

  LaneSet with_position;  ///< The position error is measured, and not by a LaneLoop.

  LaneSet amplified;     ///< The torque passes the drive kernel.
  LaneSet vibrating;     ///< Lanes with a vibration given as a series.
  LaneSet before_start;  ///< The first sample is late and has not been taken yet.

  // Torque until the next stop: constant for a whole sample, if in none.
  LaneSet varying;   ///< The torque varies until the next stop.
  LaneSet part;      ///< The stop ends only a part of a sample.
  LaneSet changing;  ///< The stop lies within a sample, and the torque changes there.

  LaneSet loaded;  ///< Lanes with a second mass.
  /// Subset of `loaded` whose torque may vary. Their steps always follow CourseLanes.
  LaneSet loaded_driven;

  LaneSet ahead;  ///< At rest, with a plant that lags behind the lane (CreepAheadLanes).

  std::array<LaneSet*, 21> all() {
    return {&active,       &sticking,    &waiting,   &standing, &sliding,       &bristles,      &elements,
            &free,         &with_blocks, &with_loop, &noisy,    &with_position, &amplified,     &vibrating,
            &before_start, &varying,     &part,      &changing, &loaded,        &loaded_driven, &ahead};
  }
};

/// A batch of trials in work: the trials in the lanes, and what remains to be done.
struct RunningBatch {
  explicit RunningBatch(const BatchSettings& settings);

  LaneTrial& trial_of(int lane) { return trials[trial_index[lane]]; }
  /// Samples of the present move so far.
  std::int64_t samples_of(int lane) const { return static_cast<std::int64_t>(state.measures.samples[lane]); }

  const Kernels& kernels;
  std::vector<LaneTrial> trials;         ///< One per lane.
  std::size_t trial_index[max_lanes]{};  ///< Index in `trials` of the trial in each lane.
  BatchState state{};                    ///< State of all lanes, as the kernels need it.
  PassedSamples passed_samples[max_lanes]{};
  LaneStates lanes;

  const TrialSource* source{nullptr};
  std::span<trial::TrialOutcome> outcomes;
  const BatchObservers* observers{nullptr};
  std::size_t next_trial{0};  ///< Index in the batch of the trial to start next.
  std::int64_t rounds{0};
  int used_lanes{0};  ///< Lanes from this index on are idle.
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

/// Starts the next trial that lanes can run, if any, in this lane. Runs the trials before it that lanes
/// cannot run by run_trial(). (lane_start.cpp)
void start_next_trial(RunningBatch& run, int lane);

/// Goes on to the next piece of the torque in the lanes that stop within a sample. (lane_torque.cpp)
void change_torques(RunningBatch& run);

/// Ends the moves whose samples have all been taken; their lanes go on to the next move or trial. @returns
/// the lanes at a sampling instant. (lane_end.cpp)
LaneSet end_moves(RunningBatch& run);

/// Processes the sampling instant of the lanes `due`: encoders, controller, converter, and measures. A lane
/// that diverges goes on to the next trial. (lane_samples.cpp)
void take_samples(RunningBatch& run, const LaneSet& due);

// One step of each lane that is between two stops: to its next stop, or to an event before it.
// (lane_steps.cpp)
void move_sticking(RunningBatch& run);
void move_sliding(RunningBatch& run);
void move_standing(RunningBatch& run);  // (lane_coulomb.cpp)
void move_bristles(RunningBatch& run);
void move_free(RunningBatch& run);

// Parts of the stages.

/// Inserts the lane, which has a trial, into the set of its motion. (lane_steps.cpp)
void set_motion(RunningBatch& run, int lane);

/// Advances the lane to its next sample by its scalar plant. Runs its trial anew if the motion does not stay
/// finite. @returns whether it does. (lane_steps.cpp)
bool follow_reference(RunningBatch& run, int lane);

/// Divides lanes by their forcing. (lane_steps.cpp)
std::array<std::pair<Forcing, LaneSet>, 4> by_forcing(const RunningBatch& run, const LaneSet& lanes);
/// Computes the torques whose series the steps of these lanes follow. (lane_steps.cpp)
void follow_torques_of(RunningBatch& run, const LaneSet& lanes);

/// Passes the torques decided at this sample through the drive kernel. (lane_torque.cpp)
void amplify(RunningBatch& run, const LaneSet& lanes);
/// Starts the present piece of the torque of the lane's drive. (lane_torque.cpp)
void begin_piece(RunningBatch& run, int lane);
/// Lets the lane's drive make the torque on the rotor from the torque decided at the last sample. If it does
/// not stay, the next stop is the end of its first piece. (lane_torque.cpp)
void drive_torque(RunningBatch& run, int lane);

/// Applies the rest rule. A lane at rest advances in closed form, by creep and residual oscillation, to the
/// next stop or to the first sampling instant at which its count differs. @returns whether the lane was at
/// rest; then it is at a stop. (lane_rest.cpp)
bool come_to_rest(RunningBatch& run, int lane);

/// Ends the lane's trial, whose move has diverged at the last sample. (lane_end.cpp)
void stop_diverged(RunningBatch& run, int lane);
/// Runs the whole trial by run_trial(). Jerks and samples already reported are not reported again.
/// (lane_end.cpp)
void run_scalar(RunningBatch& run, const LaneTrial& trial, std::int64_t reported_jerks,
                std::int64_t reported_samples);
/// Runs the lane's trial anew by run_trial(): the kernels cannot follow its motion, or the count of its
/// encoder has overflowed. (lane_end.cpp)
void fall_back_to_scalar(RunningBatch& run, int lane);
/// Moves trials from the last lanes to idle ones, once no trials are left to start in those. Kernels are
/// faster on neighbouring lanes, which share cache lines. (lane_end.cpp)
void close_gaps(RunningBatch& run);

/// Reports the last jerk of the trial that has ended. (lane_records.cpp)
void report_jerk(RunningBatch& run, LaneTrial& trial);
/// Reports the sample that has been taken last. (lane_records.cpp)
void report_sample(RunningBatch& run, int lane);
/// Reports the samples within steps, from their series. (lane_records.cpp)
void report_passed_samples(RunningBatch& run);
/// Reports, for each lane between two samples, the last sample that it has passed at rest.
void report_passed_at_rest(RunningBatch& run, const LaneSet& lanes);
/// Reports a sample at rest, `passed` samples after the last one taken. (lane_records.cpp)
void report_sample_at_rest(RunningBatch& run, int lane, double passed, double theta,
                           const friction::CreepState& creep);

}  // namespace zerocount::batch
