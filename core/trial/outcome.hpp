#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace zerocount {

/// Verdict on a move by its last samples, best first. The numbers are those stored in results files.
/// nonfinite: the motion left the finite numbers, or could not be followed (see Plant::finite). open_loop:
/// the move had a torque level and no target, so there was nothing to judge.
enum class Outcome : std::int8_t {
  zero_count = 0,
  one_count = 1,
  oscillating = 2,
  nonfinite = 3,
  open_loop = 4
};

/// What is measured of one move.
struct MoveOutcome {
  Outcome outcome{Outcome::nonfinite};
  bool arrived{false};       ///< the error was 0 for the whole dwell
  bool stable{false};        ///< arrived, and |e| ≤ 1 count from then to the end
  bool broke_away{false};    ///< the hook slid during the move
  bool saturated{false};     ///< the DAC clipped
  bool stopped{false};       ///< ended at the sample at which it had diverged, or not run after one that was
  std::int64_t arrival{-1};  ///< first sample of the arrival dwell, from the move's start; −1 if never
  double settling_time{std::numeric_limits<double>::quiet_NaN()};  ///< arrival·T, s; NaN if never
  double travel_time{0.0};      ///< until the reference, or the torque, is where it is held, s
  std::int64_t overshoot{0};    ///< largest excursion beyond the target, seen from the first count, counts
  std::int64_t final_error{0};  ///< e at the last sample, counts; −count where there is no target
  /// Distance from the rotor to the middle of the target's count at the last sample, whatever the encoder
  /// says: target − (θ/Δx + encoder_phase − ½) in fine counts. By an ideal encoder, final_error is 0 where
  /// this is in (−½, ½]. NaN where there is no target, or the motion was lost.
  double true_error{std::numeric_limits<double>::quiet_NaN()};
  double final_position{0.0};            ///< θ at the last sample, rad
  double holding_torque{0.0};            ///< torque decided at the last sample, N m
  double peak_torque{0.0};               ///< largest |torque| decided, N m
  double creep{0.0};                     ///< xp at the last sample, rad
  std::int64_t reversal_depth{0};        ///< largest number of reversal points on the stack
  std::int64_t phase_changes{0};         ///< of the control, from coarse to fine or back
  std::int64_t encoder_disagreement{0};  ///< samples at which the fine count made the coarse one impossible
  std::int64_t jerk_count{0};            ///< excursions of the error after arrival
  double jerk_agreement{
      std::numeric_limits<double>::quiet_NaN()};  ///< share of jerks towards sgn(holding_torque); NaN if none
};

/// One excursion of the error away from zero after arrival.
struct Jerk {
  std::int64_t move{0};       ///< index of the move
  double onset{0.0};          ///< s from the move's start
  double duration{0.0};       ///< s; cut at the move's end
  std::int64_t magnitude{0};  ///< max |e|, counts
  int direction{0};           ///< sgn(count − target) at onset
};

/// What is measured of a trial: one entry per move.
struct TrialOutcome {
  std::vector<MoveOutcome> moves;
};

}  // namespace zerocount
