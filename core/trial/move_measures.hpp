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

/// The name of a measure of a move in files.
struct NamedMeasure {
  std::string_view name;
  bool of_motion{false};  ///< The measure exists only with `verdict.motion`.
  /// The measure exists only if the position error is measured (VerdictParameters::position_error).
  bool of_position{false};
};

/// All measures of a move that are numbers or qualities, except the measures of error bands and tolerances.
std::span<const NamedMeasure> named_measures();

/// The measures that the bare name `settling_time` may mean, for the message that refuses it. Empty for every
/// other name. A quantile or bound may follow the name, as in `settling_time.p95` or
/// `settling_time_mean_low`.
std::string_view meanings_of_settling_time(std::string_view name);

/// The names of the measures of an error band, before the band: "band_exits" of "band_exits[1]".
std::span<const std::string_view> named_band_measures();
/// Name of the measure of a tolerance of the position error, before the tolerance.
inline constexpr std::string_view tolerance_measure = "tolerance_settling_time";

/// Times that the measures of a move refer to, in samples.
struct MoveTiming {
  double sample_time{5e-4};    ///< T, s
  std::int64_t samples{2000};  ///< Number N of samples of the move
  std::int64_t dwell{100};     ///< Dwell D: samples at zero error that make an arrival
  std::int64_t window{100};    ///< Window W: last samples of the move, which decide the outcome
  bool judged{true};           ///< False if the move has a torque level in place of a target.
  ErrorBands bands{};
  std::int64_t number{0};  ///< Number of the move in its trial
};

/// The measures of a band before the first sample.
inline constexpr BandMeasures<double> no_samples_of_band{-1.0, -1.0, 0.0};

MoveTiming move_timing(const TrialParameters& parameters, std::size_t move);

/// Distance from the rotor at `theta` (rad) to the middle of the target's count, counts (see MoveOutcome).
/// @param resolution resolution of the fine encoder, rad. @param phase phase of the fine encoder, counts.
inline double true_error(std::int64_t target, double theta, double resolution, double phase) {
  return static_cast<double>(target) - (theta / resolution + phase - 0.5);
}

/// Contribution of one sample to the measures of its move.
struct MoveSample {
  std::int64_t target{0};  ///< Target, counts; 0 without a target
  std::int64_t count{0};   ///< counts
  double torque{0.0};      ///< Torque decided at this sample, N m
  bool clipped{false};     ///< The DAC was out of range
  double theta{0.0};       ///< rad
  double creep{0.0};       ///< xp, rad
};

/// The end of a move.
struct MoveEnd {
  MoveSample last;              ///< Last sample of the move
  bool broke_away{false};       ///< The hook slid during the move
  std::int64_t reversal_depth;  ///< Largest number of reversal points on the stack
  bool stopped{false};          ///< The move has diverged and was ended.
  bool finite{true};            ///< The motion could be followed to the end.
};

/// The measures of a move. The last jerk has been ended, and the last half finished unless the move ended
/// before it.
/// @param bands measures of the bands of `timing`.
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
  /// @returns whether a jerk ended before this sample; then it is in last_jerk().
  bool add(const MoveSample& sample);

  /// Ends the move as diverged at the last sample.
  void stop() { stopped_ = true; }

  /// Finishes the move with measures of the plant. Call once, after the last sample.
  /// @returns whether a jerk was cut by the end; then it is in last_jerk().
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
