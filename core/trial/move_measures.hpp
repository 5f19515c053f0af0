#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/trial/jerks.hpp"
#include "core/trial/last_half.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"
#include "core/trial/running_measures.hpp"

namespace zerocount::trial {

/// Name of a measure of a move in files, and the conditions under which the measure exists.
struct NamedMeasure {
  std::string_view name;
  bool of_motion{false};  ///< Whether the measure exists only with `verdict.motion`, which requests measures
                          /// < of the true motion
  /// Whether the measure exists only if the position error is measured (VerdictParameters::position_error).
  bool of_position{false};
};

/// The names of all measures of a move that are numbers or qualities (true or false), except the measures of
/// error bands and tolerances.
std::span<const NamedMeasure> named_measures();

/// The measures that the bare name `settling_time` may mean, for the message that refuses it. Empty for every
/// other name. A quantile or bound may follow the name, as in `settling_time.p95` or
/// `settling_time_mean_low`.
std::string_view meanings_of_settling_time(std::string_view name);

/// The names of the measures of an error band, without the band in brackets: "band_exits" of "band_exits[1]".
std::span<const std::string_view> named_band_measures();
/// Name of the measure for a tolerance of the position error, without the tolerance in brackets.
inline constexpr std::string_view tolerance_measure = "tolerance_settling_time";

/// Lengths of time, in samples, to which the measures of a move refer.
struct MoveTiming {
  double sample_time{5e-4};    ///< Sample time T, s
  std::int64_t samples{2000};  ///< Number N of samples of the move
  std::int64_t dwell{100};     ///< Dwell D: number of successive samples with zero error that make an arrival
  std::int64_t window{100};    ///< Window W: number of samples at the end of the move that decide its outcome
  bool judged{true};           ///< Whether the move has a target; false if it has a torque level instead
  ErrorBands bands{};
  std::int64_t number{0};  ///< Number of the move in its trial, from 0
};

/// The measures of an error band before the first sample: no sample outside, no entry, no exits.
inline constexpr BandMeasures<double> no_samples_of_band{-1.0, -1.0, 0.0};

MoveTiming move_timing(const TrialParameters& parameters, std::size_t move);

/// True error: distance from the rotor at `theta` (rad) to the middle of the target's count, counts (see
/// MoveOutcome).
/// @param target counts.
/// @param resolution Δx of the fine encoder, rad.
/// @param phase phase of the fine encoder, counts.
inline double true_error(std::int64_t target, double theta, double resolution, double phase) {
  return static_cast<double>(target) - (theta / resolution + phase - 0.5);
}

/// Values of one sample that the measures of its move use.
struct MoveSample {
  std::int64_t target{0};  ///< Target of the move, counts; 0 for a move without a target
  std::int64_t count{0};   ///< Count of the fine encoder
  double torque{0.0};      ///< Torque decided at this sample, N m
  bool clipped{false};     ///< Whether the wanted code was beyond the converter's range at this sample
  double theta{0.0};       ///< Rotor angle θ, rad
  double creep{0.0};       ///< Plastic extension xp by creep, rad
};

/// State of a move at its end.
struct MoveEnd {
  MoveSample last;              ///< Last sample of the move
  bool broke_away{false};       ///< Whether the friction contact slid at any time during the move
  std::int64_t reversal_depth;  ///< Largest number of reversal points on the spring's stack during the move
  bool stopped{false};          ///< Whether the move has diverged and was ended
  bool finite{true};            ///< Whether the motion was finite and could be followed to the end
};

/// Computes the outcome of a move from its accumulated measures. The last jerk must have been ended, and the
/// last half finished unless the move ended before it.
/// @param bands measures of the error bands of `timing`.
MoveOutcome outcome_of_move(const MoveTiming& timing, const RunningMeasures<double>& measures,
                            std::span<const BandMeasures<double>> bands, const Jerks& jerks,
                            const LastHalf& last_half, const MoveEnd& end);

/// Accumulates the measures of one move sample by sample. Its memory is bounded, whatever the length of the
/// move.
class MoveMeasures {
 public:
  MoveMeasures(const MoveTiming& timing, std::int64_t move)
      : timing_(timing), jerks_(move, timing.sample_time) {
    last_half_.start(timing.samples);
    bands_.fill(no_samples_of_band);
  }

  /// Takes the next sample of the move.
  /// @returns whether a jerk (excursion of the error after arrival) ended before this sample; then
  /// last_jerk() returns it.
  bool add(const MoveSample& sample);

  /// Marks the move as diverged at the last sample, so that it ends there.
  void stop() { stopped_ = true; }

  /// Computes the outcome of the move. Call once, after the last sample.
  /// @param broke_away whether the friction contact slid during the move.
  /// @param reversal_depth largest number of reversal points.
  /// @param finite whether the motion could be followed to the end.
  /// @returns whether a jerk was cut off by the end; then last_jerk() returns it.
  bool finish(bool broke_away, std::int64_t reversal_depth, bool finite);

  const Jerk& last_jerk() const { return jerks_.last(); }
  /// Outcome of the move; valid once the move is finished.
  const MoveOutcome& outcome() const { return outcome_; }

 private:
  bool judge(const MoveSample& sample);

  MoveTiming timing_;
  RunningMeasures<double> running_{};
  std::array<BandMeasures<double>, max_error_bands> bands_;
  Jerks jerks_;
  LastHalf last_half_;
  MoveSample last_;
  bool stopped_{false};
  MoveOutcome outcome_;
};

}  // namespace zerocount::trial
