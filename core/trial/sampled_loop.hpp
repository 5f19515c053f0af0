#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/loop/controller/controller.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/measurement.hpp"
#include "core/loop/reference.hpp"
#include "core/loop/sample_clock.hpp"
#include "core/trial/motion_measures.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"
#include "core/trial/position_error.hpp"

namespace zerocount::trial {

/// The closed loop of a trial at its sampling instants, from the counts of the encoders to the code of the
/// converter, with the measures of a move that follow from it. The batch engine uses it too
/// (batch::LaneLoop).
///
///   start_move(m):  the reference goes from target m − 1, 0 at first, to target m
///   decide(i):      r ← reference at i·T
///                   if the controller runs:  code ← convert(controller(r, counts) + dither)
///                   else:                    code of the sample before, at first the code of held_torque
///   finish(m):      travel time, changes of the phase, measures of the position error and the true motion
class SampledLoop {
 public:
  /// Creates the loop of a trial.
  /// @param measurement the encoders that give the counts.
  SampledLoop(const TrialParameters& parameters, const loop::Measurement& measurement);

  /// Starts the next move, with its reference.
  /// @param number number of the move; moves come in order.
  void start_move(std::size_t number);

  struct Decision {
    std::int64_t reference;  ///< Position that the controller follows at this sample, counts
    /// Target from which the error is measured, counts: the move's target, or the reference if the reference
    /// never comes to rest (sine, record).
    std::int64_t target;
    loop::DacOutput output;
    bool ran;      ///< Whether the controller has run at this sample
    bool arrived;  ///< Whether the reference stays at the target from now on
    /// Wanted torque of the controller when it last ran, before dither, limit and rounding, N m.
    double wanted;
  };
  /// Runs the controller at a sample and decides the converter's code.
  /// @param k number of the sample, counted from the start of the trial.
  /// @param i number of the sample, counted from the start of the move.
  /// @param theta angle that the encoders have read, rad.
  /// @param other angle of the other mass, rad, if there is one.
  Decision decide(std::int64_t k, std::int64_t i, const loop::EncoderReading& reading, double theta,
                  double other);

  loop::ControlPhase phase() const { return controller_.phase(); }
  /// Whether the controller gave a torque that is not finite at the last sample; a torque of 0 was converted
  /// in its place.
  bool failed() const { return failed_; }

  /// Ends the move.
  /// @param outcome outcome of the move, complete except for the measures of this loop (travel time, phase
  /// changes, position error, true motion), which are added.
  void finish(MoveOutcome& outcome);

 private:
  const TrialParameters& p_;
  double sample_time_;
  loop::SampleClock clock_;
  loop::Controller controller_;
  loop::Converter converter_;
  double resolution_;  // of the fine encoder, rad
  std::optional<loop::Reference> reference_{};
  std::optional<MotionMeasures> motion_{};
  std::optional<PositionError> position_error_{};
  std::optional<PositionError> other_mass_{};  // of VerdictParameters::other_mass
  std::int64_t target_{0};
  std::optional<std::int64_t> last_target_{};  // at the last sample at which the controller ran
  loop::DacOutput output_{};                   // of that sample
  double wanted_{0.0};                         // likewise, N m
  bool failed_{false};
  std::int64_t phase_changes_before_{0};
};

}  // namespace zerocount::trial
