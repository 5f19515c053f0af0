#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/batch/batch.hpp"
#include "core/batch/lane_trial.hpp"

namespace zerocount::batch {

/// The lanes of a BatchEngine: assigns the trials of a batch to them, and runs the kernels in rounds.
class LaneScheduler {
 public:
  explicit LaneScheduler(const BatchSettings& settings);

  /// See BatchEngine::run.
  void run(const TrialSource& source, std::span<trial::TrialOutcome> outcomes,
           const BatchObservers& observers);

 private:
  // Trials in lanes (lane_scheduler.cpp).
  void fill_spare_lane();
  void refill(int lane);
  void close_gaps();
  void move_lane(int from, int to);
  void run_scalar(const LaneTrial& trial, std::int64_t reported_jerks, std::int64_t reported_samples);
  void fall_back_to_scalar(int lane);
  void end_move(int lane, LaneTrial& trial);
  void stop_diverged(int lane, LaneTrial& trial);
  void add_outcome(int lane, LaneTrial& trial, bool stopped);

  // Sampling instants (lane_samples.cpp).
  void take_samples();
  void note_gradual_slides(const LaneSet& due);
  void sample(void (*kernel)(BatchState&, const LaneSet&), const LaneSet& due);
  void sample_given(const LaneSet& due);
  void record_sample(int lane, const LaneTrial& trial);
  void record_passed();
  void follow_last_half(int lane, LaneTrial& trial);
  void track_jerk(int lane, LaneTrial& trial);
  void report_jerk(LaneTrial& trial);
  void drive_torque(int lane, LaneTrial& trial);
  void begin_piece(int lane, LaneTrial& trial);
  void change_torques();

  // Motion between sampling instants (lane_steps.cpp).
  void follow_torques(const LaneSet& lanes);
  bool follow_reference(int lane, LaneTrial& trial);
  void move_sticking();
  int move_sticking(LaneSet lanes, const MotionKernels& kernels);
  void wake_ahead(const LaneSet& lanes);
  void locate_events();
  void prepare_steps(LaneSet& lanes);
  bool come_to_rest(int lane);
  void end_sticking_steps();
  void move_sliding();
  void move_sliding(const LaneSet& lanes, const MotionKernels& kernels);
  void end_sliding_steps();
  void move_bristles();
  void move_bristles(const LaneSet& lanes, const MotionKernels& kernels);
  void move_free();
  void rerun_lost_lanes();

  void set_moving(int lane);
  std::array<LaneSet*, 12> sets() {
    return {&active_,      &sticking_,  &waiting_,  &sliding_, &bristles_, &free_,
            &with_blocks_, &with_loop_, &changing_, &varying_, &part_,     &ahead_};
  }
  bool is_idle(int lane) const { return !active_.contains(lane); }
  LaneTrial& trial_of(int lane) { return trials_in_work_[trial_index_[lane]]; }

  const Kernels& kernels_;
  int lane_count_;
  std::vector<LaneTrial> trials_in_work_;
  std::size_t trial_index_[max_lanes]{};  ///< [lane] index in trials_in_work_
  BatchState batch_{};
  PassedSamples passed_[max_lanes]{};
  LaneSet active_;    ///< lanes with a trial: the union of the next five
  LaneSet sticking_;  ///< the hook sticks
  LaneSet waiting_;   ///< the hook sticks; wait until enough lanes have an event in their step
  LaneSet sliding_;   ///< the hook slides
  LaneSet bristles_;  ///< with the friction of a bristle
  LaneSet free_;      ///< without friction

  LaneSet with_blocks_;  ///< active lanes whose controller has blocks
  LaneSet with_loop_;    ///< active lanes with a LaneLoop
  LaneSet changing_;     ///< active lanes whose next stop is a change of the torque within the sample
  LaneSet varying_;      ///< active lanes whose torque varies until the next stop
  LaneSet ahead_;        ///< active lanes whose plant is behind (CreepAhead)
  LaneSet part_;         ///< active lanes whose next stop ends a part of a sample

  const TrialSource* source_{nullptr};
  std::span<trial::TrialOutcome> outcomes_;
  const BatchObservers* observers_{nullptr};
  std::size_t next_trial_{0};
  int used_lanes_{0};  ///< lanes from this one on are idle
};

}  // namespace zerocount::batch
