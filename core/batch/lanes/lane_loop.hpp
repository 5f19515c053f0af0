#pragma once

#include <cstdint>
#include <optional>

#include "core/loop/dac.hpp"
#include "core/loop/drive.hpp"
#include "core/loop/measurement.hpp"
#include "core/trial/open_loop.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"
#include "core/trial/sampled_loop.hpp"

namespace zerocount::batch {

/// Scalar sampled control loop of one lane of the batch engine, for features that the vectorised sampling
/// kernels lack. It covers the path from the angle to the converter's torque: encoders, SampledLoop or
/// OpenLoop, and errors of the converter. The kernels move the rotor and keep the measures of the error.
class LaneLoop {
 public:
  explicit LaneLoop(const trial::TrialParameters& parameters);

  /// Starts move `number` towards `target` (counts).
  /// @param first_sample number of the move's first sample, counted from the start of the trial.
  void start_move(std::size_t number, std::int64_t target, std::int64_t first_sample);

  struct Decision {
    std::int64_t count;  ///< Count of the fine encoder minus reference_offset(), counts
    loop::DacOutput dac;
    double torque;  ///< Torque that the converter gives, N m
    bool may_stay;  ///< Whether the torque stays as it is while count and error stay 0
    bool stays;     ///< Whether the torque stays until the end of the move, and no random number is drawn
  };
  /// Runs encoders, controller and converter at sample i of the move.
  /// @param theta angle of the mass that the encoder reads, rad.
  /// @param other angle of the other mass, rad.
  /// @returns the decision; empty if the encoder cannot count θ, or the controller gives no finite torque.
  std::optional<Decision> sample(std::int64_t i, double theta, double other);

  /// Whether the trial has torque levels in place of targets, so that the loop is open and errors are not
  /// measured.
  bool is_open() const { return open_.has_value(); }

  /// Reference minus target at the last sample, counts. It is 0 unless the reference never comes to rest (a
  /// sine or a record).
  std::int64_t reference_offset() const { return reference_offset_; }

  /// Ends the move: adds the measures that this loop computes, such as the position error, to the outcome of
  /// the move.
  void finish(trial::MoveOutcome& outcome);

 private:
  Decision decide_open(std::int64_t k, std::int64_t i, std::int64_t count);

  loop::Measurement measurement_;
  std::optional<trial::SampledLoop> closed_;
  std::optional<trial::OpenLoop> open_;
  loop::ConverterErrors errors_;
  bool is_certain_;
  bool may_stay_;
  bool ran_before_{false};        // the controller, at the last sample
  std::int64_t first_sample_{0};  // of the move
  std::int64_t target_{0};
  std::int64_t reference_offset_{0};
  std::int64_t disagreements_before_{0};
};

}  // namespace zerocount::batch
