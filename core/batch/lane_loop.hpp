#pragma once

#include <cstdint>
#include <optional>

#include "core/loop/controller.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/drive.hpp"
#include "core/loop/measurement.hpp"
#include "core/loop/reference.hpp"
#include "core/loop/sample_clock.hpp"
#include "core/trial/motion_measures.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::batch {

/// Whether the sampled loop of the trial has a feature that the sampling kernels lack: errors of an encoder
/// or of the converter, missed samples, two phases, the coarse encoder, a reference with a profile, a plugin,
/// measures of the true motion, or more filters than they have.
bool needs_lane_loop(const trial::TrialParameters& parameters);

/// The sampled loop of a lane by the classes of the reference, from the angle to the converter's torque. The
/// kernels move the rotor and keep the measures of the error.
class LaneLoop {
 public:
  explicit LaneLoop(const trial::TrialParameters& parameters);

  /// Starts move `number`, whose first sample has this number from the start of the trial.
  void start_move(std::size_t number, std::int64_t first_sample);

  /// What is decided at a sample.
  struct Decision {
    /// Fine encoder; less the way of the reference from the target, if it moves for ever.
    std::int64_t count;
    loop::DacOutput dac;
    double torque;  ///< that the converter gives, N m
    bool may_stay;  ///< while count and error stay 0, so does the torque
  };
  /// Sample i of the move, the rotor at `theta` (rad). Empty where the encoder cannot count θ, or the
  /// controller gives no finite torque.
  std::optional<Decision> sample(std::int64_t i, double theta);

  /// The way of the reference from the target at the last sample, counts: 0 unless it moves for ever.
  std::int64_t reference_offset() const { return reference_offset_; }

  /// Ends the move: adds what is measured of it here to its outcome.
  void finish(trial::MoveOutcome& outcome);

 private:
  const trial::TrialParameters& p_;
  double sample_time_;
  loop::SampleClock clock_;
  loop::Measurement measurement_;
  loop::Controller controller_;
  loop::Converter converter_;
  loop::ConverterErrors errors_;
  bool may_stay_;
  std::optional<loop::Reference> reference_{};
  std::optional<trial::MotionMeasures> motion_{};
  std::int64_t reference_offset_{0};
  std::int64_t first_sample_{0};  // of the move
  std::int64_t target_{0};
  std::optional<std::int64_t> last_target_{};  // at the last sample at which the controller ran
  loop::DacOutput output_{};                   // of that sample
  bool ran_before_{false};                     // at the last sample
  std::int64_t phase_changes_before_{0};
  std::int64_t disagreements_before_{0};
};

/// Whether the torque may change for ever while the error stays 0: by filters, a leak, a dither or a
/// remainder.
bool remembers(const trial::TrialParameters& parameters);
bool remembers(const loop::ControlBlocks& blocks);

}  // namespace zerocount::batch
