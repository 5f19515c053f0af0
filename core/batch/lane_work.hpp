#pragma once

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
  void end_trial(int lane);
  void end_move(int lane, LaneTrial& trial);
  void stop_diverged(int lane, LaneTrial& trial);
  void add_outcome(int lane, LaneTrial& trial, bool stopped);

  // Sampling instants (lane_samples.cpp).
  void take_samples();
  void record_sample(int lane, const LaneTrial& trial);
  void record_passed();
  void follow_last_half(int lane, LaneTrial& trial);
  void track_jerk(int lane, LaneTrial& trial);
  void report_jerk(LaneTrial& trial);
  void delay_torque(int lane, LaneTrial& trial);

  // The way from one to the next (lane_steps.cpp).
  void move_sticking();
  int prepare_steps(int count);
  bool come_to_rest(int lane);
  void end_sticking_steps();
  void move_sliding();
  void end_sliding_steps();

  double moving_state(int lane) const {
    return batch_.motion.slide_direction[lane] == 0.0 ? sticking : sliding;
  }
  double& state_of(int lane) { return batch_.state[lane]; }
  LaneTrial& trial_of(int lane) { return lanes_[static_cast<std::size_t>(lane)]; }

  const Kernels& kernels_;
  int lane_count_;
  std::vector<LaneTrial> lanes_;
  BatchState batch_{};
  PassedSamples passed_[max_lanes]{};
  int list_[max_lanes]{};  ///< of lanes
  int slow_list_[max_lanes]{};
  int waiting_[max_lanes]{};  ///< lanes with an event in their step
  int waiting_count_{0};

  std::span<const trial::TrialParameters* const> trials_;
  std::span<trial::TrialOutcome> outcomes_;
  const BatchObservers* observers_{nullptr};
  std::size_t next_trial_{0};
  int used_lanes_{0};  ///< all lanes from this on are idle
  int running_{0};
};

}  // namespace zerocount::batch
