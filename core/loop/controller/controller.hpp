#pragma once

#include <cstdint>
#include <optional>

#include "core/loop/controller/control_block.hpp"
#include "core/loop/controller/control_chain.hpp"
#include "core/loop/encoder.hpp"
#include "core/loop/parameters.hpp"

namespace zerocount::loop {

/// The rule by which a two-phase control changes its phase. It uses the readings of the present phase's
/// encoder:
///
/// - fine → coarse at a sample with |e| > coarse_beyond;
/// - coarse → fine at a sample that ends D = max(1, round(fine_dwell·sample_rate)) successive samples, all of
///   the coarse phase, with |e| ≤ fine_within and |count_k − count_{k−1}| ≤ fine_rate.
///
/// The sample of a change belongs to the new phase, and there is at most one change a sample. The initial
/// phase is fine, or coarse if |e_0| > coarse_beyond; that does not count as a change.
class PhaseSwitch {
 public:
  /// Creates the rule, in the initial phase.
  /// @param sample_rate Hz.
  /// @param coarse_before counts of the coarse phase's encoder before the first sample.
  PhaseSwitch(const CoarsePhaseParameters& rule, double sample_rate, const CountsBefore& coarse_before = {});

  /// Decides the phase of this sample.
  /// @param fine, coarse errors and counts from the encoders of the two phases.
  /// @returns whether the phase has changed.
  bool update(const Feedback& fine, const Feedback& coarse);

  ControlPhase phase() const { return phase_; }      ///< Phase of the control at the last sample
  std::int64_t changes() const { return changes_; }  ///< Number of phase changes so far, in both directions.

 private:
  ControlPhase next_phase(const Feedback& fine) const;

  CoarsePhaseParameters rule_;
  double dwell_;         ///< Dwell D: number of samples in the coarse phase after which the fine phase
                         /// < begins. It may exceed the number of samples of any trial.
  double first_change_;  ///< Difference count_0 − count_{−1} of the coarse phase's encoder before the first
                         /// < sample, counts
  ControlPhase phase_{ControlPhase::fine};
  std::int64_t changes_{0};
  std::int64_t settled_{0};  ///< Number of successive samples that meet the condition for the fine phase
  /// Count of the coarse phase's encoder at the last sample; empty before the first sample.
  std::optional<double> last_coarse_count_{};
};

/// Whether the control has two phases, fine and coarse: coarse_beyond is finite.
bool has_coarse_phase(const ControllerParameters& parameters);

/// Gains and blocks of one phase of a two-phase control, as the parameters of a control without phases. In
/// the fine phase of a two-phase control kd counts as 0 (paper, practical issue 5).
ControllerParameters controller_in_phase(ControllerParameters controller, ControlPhase phase);

/// The controller's parameters with its standstill gains in place of its normal gains; empty if it has no
/// standstill gains.
std::optional<ControllerParameters> controller_at_standstill(ControllerParameters controller);

/// Linear descriptions of the controller's blocks, without their limits.
/// @param parameters a control without phases.
LinearChain linear_chain(const ControllerParameters& parameters, const EncoderParameters& encoders);

/// Range to which anti-windup clamps the controller's integral, N m.
/// @param lowest, highest range of the DAC, N m.
TorqueRange integral_range(AntiWindup anti_windup, double lowest, double highest);

/// The controller: it computes the wanted torque from the encoders' counts. It has one chain of blocks, or
/// two for the two phases (PhaseSwitch). Each chain gets the feedback of its own encoder; the coarse phase
/// reads no encoder of the other mass. Errors and counts are in counts of the fine encoder; the count of a
/// coarse encoder is multiplied by fine/coarse.
///
/// On a change of phase at sample k the new chain sets I to the torque in force; with blocks, to the torque
/// with which the chain gives the one in force in the steady state (ControlBlock::take_over). Its previous
/// error and count, e_{k−1} and count_{k−1}, are readings of its own encoder. Without blocks the torque
/// therefore changes only by ki·(e_k + e_{k−1}) + kp·e_k − kd·(count_k − count_{k−1}).
class Controller {
 public:
  /// Creates the controller.
  /// @param integral integral I before the first sample, in the phase of that sample, N m.
  /// @param start position and velocity at the start, which give the counts before the first sample.
  Controller(const ControllerParameters& parameters, const EncoderParameters& encoders, double integral,
             const DacScale& dac, const StartOfMotion& start = {});

  /// Sets the state to the steady state in which the axis stands still under this torque (N m). To be called
  /// before the first sample, whose torque_in_force is to be that torque.
  void hold(double torque);

  /// Computes the wanted torque (N m) at this sample.
  /// @param reference reference in counts of the fine encoder.
  /// @param motion motion of the reference before it is rounded to counts.
  /// @param torque_in_force the torque decided at the last sample, N m; 0 before the first. A torque of the
  /// DAC, hence within its range.
  /// @param new_target whether the target differs from that of the last update.
  /// @param sample number of the sample, counted from the start of the trial.
  double update(std::int64_t reference, const EncoderReading& reading, double torque_in_force,
                const ReferenceMotion& motion = {}, bool new_target = false, std::int64_t sample = 0);

  /// Phase of the control at the last sample
  ControlPhase phase() const { return switch_.phase(); }
  /// Number of changes between fine and coarse phase so far
  std::int64_t phase_changes() const { return switch_.changes(); }
  double integral() const;  ///< Integral I of the chain whose phase decided the last sample, N m

 private:
  double count_of(EncoderChoice encoder, const EncoderReading& reading) const;

  bool two_phases_;
  EncoderChoice fine_encoder_;    ///< Encoder that closes the loop in the fine phase
  EncoderChoice coarse_encoder_;  ///< Encoder that closes the loop in the coarse phase
  bool velocity_by_other_;  ///< Whether the velocity loop of the fine phase reads the encoder on the other
                            /// < mass
  double fine_per_coarse_;
  ControlChain fine_;    ///< Blocks of the fine phase
  ControlChain coarse_;  ///< Blocks of the coarse phase
  PhaseSwitch switch_;
};

}  // namespace zerocount::loop
