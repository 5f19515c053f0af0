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
  /// Time k·T of the smallest k such that |e_k|, …, |e_{k+D−1}| ≤ b, with D the dwell time in samples, s;
  /// NaN if never.
  double entry_time{std::numeric_limits<double>::quiet_NaN()};
  /// Settling time: k·T of the smallest k such that |e_k|, …, |e_{N−1}| ≤ b, s; NaN where |e_{N−1}| > b.
  double settling_time{std::numeric_limits<double>::quiet_NaN()};
  /// Number of times that the error left the band (maximal runs of samples with |e| > b) after it had first
  /// stayed in the band for the dwell time; 0 if it never did.
  double exits{std::numeric_limits<double>::quiet_NaN()};
};

/// An array of settling times that are all NaN.
constexpr std::array<double, max_tolerances> filled_with_nan() {
  std::array<double, max_tolerances> times{};
  times.fill(std::numeric_limits<double>::quiet_NaN());
  return times;
}

/// Measures of one move of a trial.
struct MoveOutcome {
  std::int64_t number{0};  ///< Number of the move in its trial, from 0
  Outcome outcome{Outcome::nonfinite};
  bool arrived{false};     ///< Whether the move arrived: the error was 0 for the whole dwell time
  bool stable{false};      ///< Whether the move arrived, and |e| ≤ 1 count from then to the end
  bool broke_away{false};  ///< Whether the friction contact slid at any time during the move
  bool saturated{false};   ///< Whether the wanted code was beyond the converter's range at any sample
  /// Whether the controller gave no finite torque, in this move or one before: the outcome is nonfinite.
  bool controller_failed{false};
  bool stopped{false};       ///< Whether the move was ended at the sample at which it had diverged, or was
                             ///< not run because an earlier move had diverged
  std::int64_t arrival{-1};  ///< Number of the sample, from the move's start, from which the error first
                             ///< stayed 0 for the dwell time; −1 if the move never arrived
  /// Arrival time: arrival·T, s; NaN if the move never arrived
  double arrival_time{std::numeric_limits<double>::quiet_NaN()};
  /// Final settling time: k·T of the smallest k such that e_k = … = e_{N−1} = 0, s; NaN where e_{N−1} ≠ 0, or
  /// the motion was lost.
  double final_settling_time{std::numeric_limits<double>::quiet_NaN()};
  /// Proportion of the samples from arrival to the end with e = 0; NaN if the move never arrived.
  double zero_fraction{std::numeric_limits<double>::quiet_NaN()};
  /// (max − min)/2 of the count over the last half of an oscillating move that was not ended early (see
  /// LastHalf), counts; otherwise NaN.
  double oscillation_amplitude{std::numeric_limits<double>::quiet_NaN()};
  /// Mean time between upward crossings of the middle (max + min)/2 by the count in the last half of the
  /// move, s; NaN for fewer than two crossings.
  double oscillation_period{std::numeric_limits<double>::quiet_NaN()};
  /// Time until the reference, or the torque in an open loop, has reached the value at which it is held, s;
  /// NaN for a sine
  double travel_time{0.0};
  std::int64_t overshoot{0};  ///< Largest excursion of the count beyond the target, in the direction from the
                              ///< first count to the target, counts
  /// Control error at sample ⌈N/2⌉, or at the only sample, counts; 0 if the move was cut short, or has no
  /// target.
  std::int64_t midway_error{0};
  std::int64_t final_error{0};  ///< Control error e at the last sample, counts; −count without a target
  /// Distance of the rotor (of the load, if the encoder is there) from the middle of the target's count at
  /// the last sample, whatever the encoder reads: target − (θ/Δx + encoder_phase − ½) in fine counts. With an
  /// ideal encoder, final_error is 0 if this is in (−½, ½]. NaN without a target, or if the motion was lost.
  double true_error{std::numeric_limits<double>::quiet_NaN()};
  double final_position{0.0};            ///< Rotor angle θ at the last sample, rad
  double holding_torque{0.0};            ///< Torque that the controller decided at the last sample, N m
  double peak_torque{0.0};               ///< Largest absolute torque that the controller decided during the
                                         ///< move, N m
  double creep{0.0};                     ///< Plastic extension xp by creep at the last sample, rad
  std::int64_t reversal_depth{0};        ///< Largest number of reversal points on the spring's stack during
                                         ///< the move
  std::int64_t phase_changes{0};         ///< Number of phase changes of a two-phase control, from coarse to
                                         ///< fine or back
  std::int64_t encoder_disagreement{0};  ///< Number of samples at which the fine count made the coarse count
                                         ///< impossible
  std::int64_t jerk_count{0};            ///< Number of jerks, excursions of the error from zero after arrival
  /// Proportion of jerks in the direction of the holding torque, sgn(holding_torque); NaN if there are none
  double jerk_agreement{std::numeric_limits<double>::quiet_NaN()};
  /// Measures of the error bands, [band] of VerdictParameters
  std::array<BandOutcome, max_error_bands> bands{};

  // Measures of the position error ε, if they are asked for (see PositionError); NaN if the move was stopped
  // or its motion was lost.
  /// Settling time for each tolerance of VerdictParameters: k·T with the smallest k such that |ε_k|, …,
  /// |ε_{N−1}| ≤ tolerance, s; NaN if |ε_{N−1}| is larger.
  std::array<double, max_tolerances> tolerance_settling_times = filled_with_nan();
  /// True overshoot: largest distance of the true position beyond the target, −ε_k·sgn(r − target before), at
  /// least 0, rad; NaN if it is not measured.
  double true_overshoot{std::numeric_limits<double>::quiet_NaN()};
  /// Settling times (s), followed by overshoot (rad) and true error (counts), of the mass
  /// VerdictParameters::other_mass.
  std::array<double, max_tolerances> other_tolerance_settling_times = filled_with_nan();
  double other_true_overshoot{std::numeric_limits<double>::quiet_NaN()};
  double other_true_error{std::numeric_limits<double>::quiet_NaN()};

  // Measures of the true motion, if they are asked for (see MotionMeasures); otherwise NaN.
  /// Root mean square of the true error at rest, counts; rest_error_range is its peak-to-peak value. Rest
  /// lasts from the first sample of the dwell within the rest band to the end of the move.
  double rest_error_rms{std::numeric_limits<double>::quiet_NaN()};
  double rest_error_range{std::numeric_limits<double>::quiet_NaN()};
  /// Root mean square of the true error at rest (rest_error_rms), in rad
  double rest_motion_rms{std::numeric_limits<double>::quiet_NaN()};
  /// Peak-to-peak value of the true error at rest (rest_error_range), in rad
  double rest_motion_range{std::numeric_limits<double>::quiet_NaN()};
  /// Mean square of the torque decided at rest, (N m)²; rest_torque_noise is the mean square of its changes
  /// from one sample to the next.
  double rest_torque_power{std::numeric_limits<double>::quiet_NaN()};
  double rest_torque_noise{std::numeric_limits<double>::quiet_NaN()};
  /// Root mean square of the following error, counts; following_error_peak is its peak. The following error
  /// is the reference before rounding minus the true position, while a profile lasts, or from the second
  /// period of a sine on.
  double following_error_rms{std::numeric_limits<double>::quiet_NaN()};
  double following_error_peak{std::numeric_limits<double>::quiet_NaN()};
  /// Largest |following error| in the quarter of a period after a reversal of a sine reference, counts.
  double reversal_spike{std::numeric_limits<double>::quiet_NaN()};
  /// Mean true position over the window at the end of the move minus the mean over the window of the move
  /// before, counts.
  double step_motion{std::numeric_limits<double>::quiet_NaN()};
  bool step_made{false};  ///< Whether step_motion is within half of the commanded step
};

/// One jerk: an excursion of the error from zero after arrival.
struct Jerk {
  std::int64_t move{0};       ///< Number of the move in its trial, from 0
  double onset{0.0};          ///< Time of its first sample from the start of the move, s
  double duration{0.0};       ///< Time until the error is 0 again, at most until the end of the move, s
  std::int64_t magnitude{0};  ///< Largest |e| during the jerk, counts
  int direction{0};           ///< Direction of the excursion at its first sample, sgn(count − target)
};

/// Measures of a trial, with one entry per move.
struct TrialOutcome {
  std::vector<MoveOutcome> moves;
};

/// The outcome of a trial: the worst of the outcomes of its moves (see severity()).
inline Outcome worst_outcome(std::span<const MoveOutcome> moves) {
  Outcome worst = Outcome::open_loop;
  for (const MoveOutcome& move : moves) {
    if (severity(move.outcome) > severity(worst)) worst = move.outcome;
  }
  return worst;
}

/// Whether an outcome is a success, a zero count at the end. Applies to the outcome of a move and to the
/// worst outcome of a trial.
constexpr bool is_success(Outcome outcome) {
  return outcome == Outcome::zero_count;
}

/// Whether a trial succeeded: all of its moves ended with a zero count.
inline bool succeeded(std::span<const MoveOutcome> moves) {
  return std::all_of(moves.begin(), moves.end(),
                     [](const MoveOutcome& move) { return is_success(move.outcome); });
}

}  // namespace zerocount::trial
