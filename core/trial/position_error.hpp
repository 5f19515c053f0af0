#pragma once

#include <array>
#include <cstdint>

#include "core/loop/reference.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::trial {

/// Measures of the position error of each move,
///
///   ε_k = (r + ½ − encoder_phase)·Δx − θ_k.
///
/// Here r is the target in counts before rounding; for a sine or a record it is the reference at t_k. θ is
/// the angle of the mass whose encoder closes the loop, or of the other mass. For both masses, r, Δx and
/// encoder_phase belong to the encoder that closes the loop. The measures do not depend on the readings of
/// the encoder.
class PositionError {
 public:
  /// Prepares the measures of a trial.
  /// @param resolution Δx of the fine encoder, rad.
  PositionError(const TrialParameters& parameters, double resolution);

  /// Starts to measure the next move.
  /// @param number number of the move from 0; moves come in order.
  void start_move(std::size_t number);

  /// Takes sample k of the move.
  /// @param theta angle θ of the measured mass, rad.
  void add(std::int64_t k, double theta, const loop::Reference& reference);
  /// Takes sample k of a move whose target does not move. At the samples that were left out since the last
  /// call, the angle must have been within quiet_range().
  /// @param theta angle θ of the measured mass, rad.
  void add_at_target(std::int64_t k, double theta);

  /// A range of angles of the measured mass, rad.
  struct Range {
    double low;
    double high;
  };
  /// Range of angles around the last one in which a sample neither leaves nor enters a tolerance and does not
  /// exceed the overshoot so far, so that samples in it need not be taken. Only for a move whose target does
  /// not move.
  Range quiet_range() const;

  double last() const { return error_; }  ///< Position error ε of the last sample, rad

  /// Adds the settling times and the true overshoot of the move to its outcome, whose other measures are
  /// final.
  void finish(MoveOutcome& outcome) const;

 private:
  /// Target of move `number` before it is rounded to counts, rad, measured from the position at the start of
  /// the trial.
  double exact_target(std::size_t number) const;
  /// Takes sample k.
  /// @param theta angle of the measured mass, rad.
  /// @param followed angle that the mass should have, rad.
  void add_error(std::int64_t k, double theta, double followed);

  const TrialParameters& p_;
  double resolution_;
  double offset_;          // (½ − encoder_phase)·Δx, rad
  double target_{0.0};     // rad
  double direction_{0.0};  // of the move: −1, 0 or 1
  double overshoot_{0.0};  // so far, rad
  double error_{0.0};      // ε of the last sample, rad
  std::int64_t last_{-1};  // sample
  std::array<std::int64_t, max_tolerances> last_outside_{};
};

}  // namespace zerocount::trial
