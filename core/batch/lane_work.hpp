#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/batch/batch.hpp"
#include "core/batch/lane_trial.hpp"

namespace zerocount::batch {

/// The lanes of a BatchEngine, and their way through a batch of trials.
class LaneWork {
 public:
  explicit LaneWork(const BatchSettings& settings);

  /// See BatchEngine::run.
  void run(std::span<const trial::TrialParameters* const> trials, std::span<trial::TrialOutcome> outcomes,
           const BatchObservers& observers);

 private:
  // Trials come and go (lane_work.cpp).
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
  void record_sample(int lane, const LaneTrial& trial);
  void record_passed();
  void follow_last_half(int lane, LaneTrial& trial);
  void track_jerk(int lane, LaneTrial& trial);
  void report_jerk(LaneTrial& trial);
  void delay_torque(int lane, LaneTrial& trial);

  // The way from one to the next (lane_steps.cpp).
  void move_sticking();
  void prepare_steps(LaneSet& lanes);
  bool come_to_rest(int lane);
  void end_sticking_steps();
  void move_sliding();
  void end_sliding_steps();
  void move_bristles();
  void move_free();
  void give_up_lost();

  void set_moving(int lane);
  std::array<LaneSet*, 7> sets() {
    return {&active_, &sticking_, &waiting_, &sliding_, &bristles_, &free_, &with_blocks_};
  }
  bool is_idle(int lane) const { return !active_.contains(lane); }
  LaneTrial& trial_of(int lane) { return trials_in_work_[trial_index_[lane]]; }

  const Kernels& kernels_;
  int lane_count_;
  std::vector<LaneTrial> trials_in_work_;
  std::size_t trial_index_[max_lanes]{};  ///< which of them a lane has
  BatchState batch_{};
  PassedSamples passed_[max_lanes]{};
  LaneSet active_;    ///< lanes with a trial: those below together
  LaneSet sticking_;  ///< the hook sticks
  LaneSet waiting_;   ///< it sticks; they wait until enough lanes have an event in their step
  LaneSet sliding_;   ///< the hook slides
  LaneSet bristles_;  ///< friction is that of a bristle
  LaneSet free_;      ///< there is no friction

  LaneSet with_blocks_;  ///< of the active ones, those whose controller has blocks

  std::span<const trial::TrialParameters* const> trials_;
  std::span<trial::TrialOutcome> outcomes_;
  const BatchObservers* observers_{nullptr};
  std::size_t next_trial_{0};
  int used_lanes_{0};  ///< all lanes from this on are idle
};

}  // namespace zerocount::batch
