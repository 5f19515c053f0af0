#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/trial/error_bands.hpp"

namespace zerocount::trial {

/// Verdict on a move with N samples, by the last W of them. The numbers are stored in results files;
/// severity() orders them from best to worst.
///
///   zero_count   all e_k = 0
///   one_count    max |e_k| = 1
///   off_target   max |e_k| > 1, and for every sample k from h = ⌈N/2⌉ to N − 1 sgn e_k = sgn e_h and
///                |e_k| ≤ |e_h|: stalled, or still approaching (for N = 1 no such sample exists)
///   oscillating  max |e_k| > 1 otherwise, or ended early because it had diverged
///   nonfinite    the motion left the finite numbers, or could not be followed (see Plant::finite), or the
///                controller gave no finite torque
///   open_loop    the move had a torque level in place of a target
enum class Outcome : std::int8_t {
  zero_count = 0,
  one_count = 1,
  oscillating = 2,
  nonfinite = 3,
  open_loop = 4,
  off_target = 5
};

/// Position of an outcome from best to worst: zero_count, one_count, off_target, oscillating, nonfinite. A
/// move that was not judged (open_loop) has the position of the best.
constexpr int severity(Outcome outcome) {
  switch (outcome) {
    case Outcome::open_loop:
      return 0;
    case Outcome::zero_count:
      return 1;
    case Outcome::one_count:
      return 2;
    case Outcome::off_target:
      return 3;
    case Outcome::oscillating:
      return 4;
    case Outcome::nonfinite:
      return 5;
  }
  return 6;  // an invalid number, from a damaged file
}

/// Measures of one error band |e| ≤ b of a move. NaN where the move was stopped, lost its motion or has no
/// target.
struct BandOutcome {
  /// k·T with the smallest k such that |e_k|, …, |e_{k+D−1}| ≤ b, s; NaN if never.
  double entry_time{std::numeric_limits<double>::quiet_NaN()};
  /// k·T with the smallest k such that |e_k|, …, |e_{N−1}| ≤ b, s; NaN where |e_{N−1}| > b.
  double settling_time{std::numeric_limits<double>::quiet_NaN()};
  /// Maximal runs of samples with |e| > b after the entry dwell; 0 if the band was never entered.
  double exits{std::numeric_limits<double>::quiet_NaN()};
};

/// Settling times that are all NaN.
constexpr std::array<double, max_tolerances> filled_with_nan() {
  std::array<double, max_tolerances> times{};
  times.fill(std::numeric_limits<double>::quiet_NaN());
  return times;
}

/// Measures of one move.
struct MoveOutcome {
  std::int64_t number{0};  ///< Number of the move in its trial, from 0
  Outcome outcome{Outcome::nonfinite};
  bool arrived{false};     ///< The error was 0 for the whole dwell
  bool stable{false};      ///< arrived, and |e| ≤ 1 count from then to the end
  bool broke_away{false};  ///< The hook slid during the move
  bool saturated{false};   ///< The DAC clipped
  /// The controller gave no finite torque, in this move or one before: the outcome is nonfinite.
  bool controller_failed{false};
  bool stopped{false};       ///< Ended at the sample at which it had diverged, or not run after one that was
  std::int64_t arrival{-1};  ///< First sample of the arrival dwell, from the move's start; −1 if never
  double arrival_time{std::numeric_limits<double>::quiet_NaN()};  ///< arrival·T, s; NaN if never
  /// k·T with the smallest k such that e_k = … = e_{N−1} = 0, s; NaN where e_{N−1} ≠ 0, or the motion was
  /// lost.
  double final_settling_time{std::numeric_limits<double>::quiet_NaN()};
  /// Fraction of the samples from arrival to the end with e = 0; NaN if the move never arrived.
  double zero_fraction{std::numeric_limits<double>::quiet_NaN()};
  /// (max − min)/2 of the count over the last half of an oscillating move that was not ended early (see
  /// LastHalf), counts; otherwise NaN.
  double oscillation_amplitude{std::numeric_limits<double>::quiet_NaN()};
  /// Mean time between upward crossings of (max + min)/2 in the same samples, s; NaN for fewer than two.
  double oscillation_period{std::numeric_limits<double>::quiet_NaN()};
  /// Time until the reference, or the torque, has come to where it is held, s; NaN for a sine
  double travel_time{0.0};
  std::int64_t overshoot{0};  ///< Largest excursion beyond the target, seen from the first count, counts
  /// Error at sample ⌈N/2⌉, or at the only sample, counts; 0 if the move was cut, or has no target.
  std::int64_t midway_error{0};
  std::int64_t final_error{0};  ///< e at the last sample, counts; −count without a target
  /// Distance from the rotor, or the load where the encoder is there, to the middle of the target's count at
  /// the last sample, whatever the encoder says: target − (θ/Δx + encoder_phase − ½) in fine counts. With
  /// an ideal encoder, final_error is 0 if this is in (−½, ½]. NaN without a target, or if the motion was
  /// lost.
  double true_error{std::numeric_limits<double>::quiet_NaN()};
  double final_position{0.0};            ///< θ at the last sample, rad
  double holding_torque{0.0};            ///< Torque decided at the last sample, N m
  double peak_torque{0.0};               ///< Largest |torque| decided, N m
  double creep{0.0};                     ///< xp at the last sample, rad
  std::int64_t reversal_depth{0};        ///< Largest number of reversal points on the stack
  std::int64_t phase_changes{0};         ///< Phase changes of the control, from coarse to fine or back
  std::int64_t encoder_disagreement{0};  ///< Samples at which the fine count made the coarse one impossible
  std::int64_t jerk_count{0};            ///< Excursions of the error after arrival
  double jerk_agreement{std::numeric_limits<double>::quiet_NaN()};  ///< Proportion of jerks towards
                                                                    ///< sgn(holding_torque); NaN if none
  std::array<BandOutcome, max_error_bands> bands{};                 ///< [band] of VerdictParameters

  // Measures of the position error ε, if they are asked for (see PositionError); NaN if the move was stopped
  // or its motion was lost.
  /// Settling time for each tolerance of VerdictParameters: k·T with the smallest k such that |ε_k|, …,
  /// |ε_{N−1}| ≤ tolerance, s; NaN if |ε_{N−1}| is larger.
  std::array<double, max_tolerances> tolerance_settling_times = filled_with_nan();
  /// True overshoot: the largest −ε_k·sgn(r − target before), at least 0, rad.
  double true_overshoot{std::numeric_limits<double>::quiet_NaN()};
  /// Settling times (s), overshoot (rad) and true error (counts) of VerdictParameters::other_mass.
  std::array<double, max_tolerances> other_tolerance_settling_times = filled_with_nan();
  double other_true_overshoot{std::numeric_limits<double>::quiet_NaN()};
  double other_true_error{std::numeric_limits<double>::quiet_NaN()};

  // Measures of the true motion, if they are asked for (see MotionMeasures); otherwise NaN.
  /// Rms of the true error at rest, counts; rest_error_range is its peak-to-peak value. Rest lasts from the
  /// first sample of the dwell within the rest band to the end of the move.
  double rest_error_rms{std::numeric_limits<double>::quiet_NaN()};
  double rest_error_range{std::numeric_limits<double>::quiet_NaN()};
  double rest_motion_rms{std::numeric_limits<double>::quiet_NaN()};    ///< rest_error_rms, rad
  double rest_motion_range{std::numeric_limits<double>::quiet_NaN()};  ///< rest_error_range, rad
  /// Mean square of the torque decided at rest, (N m)²; rest_torque_noise is the mean square of its changes
  /// from one sample to the next.
  double rest_torque_power{std::numeric_limits<double>::quiet_NaN()};
  double rest_torque_noise{std::numeric_limits<double>::quiet_NaN()};
  /// Rms of the following error, counts; following_error_peak is its peak. It is the reference before
  /// rounding minus the true position, while a profile lasts, or from the second period of a sine on.
  double following_error_rms{std::numeric_limits<double>::quiet_NaN()};
  double following_error_peak{std::numeric_limits<double>::quiet_NaN()};
  /// Largest |following error| in a quarter of a period after a reversal of the sine, counts.
  double reversal_spike{std::numeric_limits<double>::quiet_NaN()};
  /// Mean true position over the window minus the mean over the window of the move before, counts.
  double step_motion{std::numeric_limits<double>::quiet_NaN()};
  bool step_made{false};  ///< step_motion is within half of the commanded step
};

/// One excursion of the error away from zero after arrival.
struct Jerk {
  std::int64_t move{0};       ///< Index of the move
  double onset{0.0};          ///< Time from the start of the move, s
  double duration{0.0};       ///< Time until the error is 0 again, at most until the end of the move, s
  std::int64_t magnitude{0};  ///< max |e|, counts
  int direction{0};           ///< sgn(count − target) at onset
};

/// Measures of a trial: one entry per move.
struct TrialOutcome {
  std::vector<MoveOutcome> moves;
};

/// The outcome of a trial, which is the outcome of its worst move.
inline Outcome worst_outcome(std::span<const MoveOutcome> moves) {
  Outcome worst = Outcome::open_loop;
  for (const MoveOutcome& move : moves) {
    if (severity(move.outcome) > severity(worst)) worst = move.outcome;
  }
  return worst;
}

/// Whether a move with this outcome, or a trial with this worst outcome, succeeded: it ended with a zero
/// count.
constexpr bool is_success(Outcome outcome) {
  return outcome == Outcome::zero_count;
}

/// Whether a trial succeeded, which it did if all of its moves succeeded.
inline bool succeeded(std::span<const MoveOutcome> moves) {
  return std::all_of(moves.begin(), moves.end(),
                     [](const MoveOutcome& move) { return is_success(move.outcome); });
}

}  // namespace zerocount::trial
