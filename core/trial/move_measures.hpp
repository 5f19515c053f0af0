#pragma once

#include <cstdint>

#include "core/trial/last_half.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount {

/// How a move is measured, in samples.
struct MoveTiming {
  double sample_time{5e-4};    ///< T, s
  std::int64_t samples{2000};  ///< N, of the move
  std::int64_t dwell{100};     ///< D, samples at zero error that make an arrival
  std::int64_t window{100};    ///< W, last samples that decide the outcome
  bool judged{true};           ///< false where the move has no target, but a torque level
};

MoveTiming move_timing(const TrialParameters& parameters, std::size_t move);

/// Distance from the rotor at `theta` (rad) to the middle of the target's count, counts (see MoveOutcome).
/// @param resolution of the fine encoder, rad. @param phase of it, in counts.
inline double true_error(std::int64_t target, double theta, double resolution, double phase) {
  return static_cast<double>(target) - (theta / resolution + phase - 0.5);
}

/// What is known of a move with a target when its last sample was taken.
struct MoveEnd {
  std::int64_t target{0};             ///< counts
  std::int64_t samples{0};            ///< taken
  std::int64_t zeros_in_a_row{0};     ///< up to the last sample
  std::int64_t jerk_samples{0};       ///< samples in a jerk
  std::int64_t largest_in_window{0};  ///< max |e| in the last W samples, counts
  bool finite{true};                  ///< the motion could be followed
};

/// Completes the measures of a move with a target: its verdict and all that is known at its end alone.
/// `outcome` has what was measured sample by sample: stopped, arrival, holding_torque, final_error. The last
/// half has been finished, unless the move was ended before it.
void judge_end(const MoveTiming& timing, const MoveEnd& end, const LastHalf& last_half, MoveOutcome& outcome);

/// What one sample contributes to the measures of its move.
struct MoveSample {
  std::int64_t target{0};  ///< counts; 0 where there is none
  std::int64_t count{0};   ///< counts
  double torque{0.0};      ///< decided at this sample, N m
  bool clipped{false};     ///< the DAC was out of range
  double theta{0.0};       ///< rad
  double creep{0.0};       ///< xp, rad
};

/// The measures of one move, taken sample by sample. What is kept of the move are running values and what
/// LastHalf keeps, which has a limit: the memory does not grow with the length of the move.
class MoveMeasures {
 public:
  MoveMeasures(const MoveTiming& timing, std::int64_t move) : timing_(timing), move_(move) {
    last_half_.start(timing.samples);
  }

  /// Takes the next sample of the move.
  /// @returns whether a jerk ended before this sample; then it is in last_jerk().
  bool add(const MoveSample& sample);

  /// Says that the move has diverged with the sample taken last, and that there will be no other.
  void stop() { outcome_.stopped = true; }

  /// Ends the move: takes what the plant did during it. Call once, after the last sample.
  /// @returns whether a jerk was cut by the end; then it is in last_jerk().
  bool finish(bool broke_away, std::int64_t reversal_depth, bool finite);

  const Jerk& last_jerk() const { return jerk_; }
  const MoveOutcome& outcome() const { return outcome_; }

 private:
  bool judge(const MoveSample& sample);
  void follow_last_half(std::int64_t count);
  bool track_jerk(std::int64_t error);
  void end_jerk();

  MoveTiming timing_;
  std::int64_t move_;
  MoveOutcome outcome_;

  std::int64_t k_{0};
  std::int64_t target_{0};  // of the last sample
  std::int64_t count_{0};   // of the last sample
  std::int64_t zeros_in_a_row_{0};
  int direction_{0};                       // of the move
  std::int64_t largest_since_arrival_{0};  // max |e|
  std::int64_t largest_in_window_{0};      // max |e|
  Jerk jerk_;
  bool in_jerk_{false};
  std::int64_t jerk_start_{0};
  std::int64_t jerks_up_{0};
  std::int64_t jerks_down_{0};
  std::int64_t jerk_samples_{0};
  LastHalf last_half_;
};

}  // namespace zerocount
