#pragma once

#include <cstdint>

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

/// The verdict on a move whose largest |e| in the window is `largest_error` (counts).
/// @param finite the motion could be followed. @param judged the move had a target.
Outcome verdict(std::int64_t largest_error, bool finite, bool judged);

/// What one sample contributes to the measures of its move.
struct MoveSample {
  std::int64_t target{0};  ///< counts; 0 where there is none
  std::int64_t count{0};   ///< counts
  double torque{0.0};      ///< decided at this sample, N m
  bool clipped{false};     ///< the DAC was out of range
  double theta{0.0};       ///< rad
  double creep{0.0};       ///< xp, rad
};

/// The measures of one move, taken sample by sample: nothing of the move is kept but running values, so the
/// memory does not grow with its length.
class MoveMeasures {
 public:
  MoveMeasures(const MoveTiming& timing, std::int64_t move) : timing_(timing), move_(move) {}

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
  bool judge(std::int64_t error);
  bool track_jerk(std::int64_t error);
  void end_jerk();

  MoveTiming timing_;
  std::int64_t move_;
  MoveOutcome outcome_;

  std::int64_t k_{0};
  std::int64_t zeros_in_a_row_{0};
  int direction_{0};                       // of the move
  std::int64_t largest_since_arrival_{0};  // max |e|
  std::int64_t largest_in_window_{0};      // max |e|
  Jerk jerk_;
  bool in_jerk_{false};
  std::int64_t jerk_start_{0};
  std::int64_t jerks_up_{0};
  std::int64_t jerks_down_{0};
};

}  // namespace zerocount
