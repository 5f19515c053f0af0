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
  /// @param sample_rate Hz.
  /// @param coarse_before counts of the coarse phase before the first sample.
  PhaseSwitch(const CoarsePhaseParameters& rule, double sample_rate, const CountsBefore& coarse_before = {});

  /// Decides the phase of this sample.
  /// @param fine, coarse readings of the encoders of the two phases.
  /// @returns whether the phase has changed.
  bool update(const Feedback& fine, const Feedback& coarse);

  ControlPhase phase() const { return phase_; }      ///< Phase of the last sample.
  std::int64_t changes() const { return changes_; }  ///< Number of phase changes so far, in both directions.

 private:
  ControlPhase next_phase(const Feedback& fine) const;

  CoarsePhaseParameters rule_;
  double dwell_;         ///< Dwell D in samples; it may exceed the number of samples of any trial.
  double first_change_;  ///< count_0 − count_{−1} of the coarse phase
  ControlPhase phase_{ControlPhase::fine};
  std::int64_t changes_{0};
  std::int64_t settled_{0};  ///< Successive samples that meet the condition for the fine phase.
  /// Count of the coarse phase at the last sample; empty before the first.
  std::optional<double> last_coarse_count_{};
};

/// Whether the control has two phases, which it has if coarse_beyond is finite.
bool has_coarse_phase(const ControllerParameters& parameters);

/// The gains and blocks of one phase of the control, as a control without phases. In the fine phase of a
/// two-phase control kd counts as 0 (paper, practical issue 5).
ControllerParameters controller_in_phase(ControllerParameters controller, ControlPhase phase);

/// The controller with its standstill gains in place of its gains; empty if it has none.
std::optional<ControllerParameters> controller_at_standstill(ControllerParameters controller);

/// The blocks of a control without phases, away from their limits.
LinearChain linear_chain(const ControllerParameters& parameters, const EncoderParameters& encoders);

/// Range to which anti-windup clamps the integral. @param lowest, highest range of the DAC, N m.
TorqueRange integral_range(AntiWindup anti_windup, double lowest, double highest);

/// The control of the count: one chain of blocks, or two for the two phases (PhaseSwitch). Each chain is fed
/// back from its own encoder; the coarse phase reads no encoder of the other mass. Errors and counts are in
/// counts of the fine encoder; the count of a coarse encoder is multiplied by fine/coarse.
///
/// On a change of phase at sample k the new chain sets I to the torque in force; with blocks, to the torque
/// with which the chain gives the one in force in the steady state (ControlBlock::take_over). Its previous
/// error and count, e_{k−1} and count_{k−1}, are readings of its own encoder. Without blocks the torque
/// therefore changes only by ki·(e_k + e_{k−1}) + kp·e_k − kd·(count_k − count_{k−1}).
class Controller {
 public:
  /// @param integral I before the first sample, N m, of the phase of that sample.
  /// @param start position and velocity at the start, which give the counts before the first sample.
  Controller(const ControllerParameters& parameters, const EncoderParameters& encoders, double integral,
             const DacScale& dac, const StartOfMotion& start = {});

  /// Starts from the steady state in which the axis stands still under this torque (N m). To be called before
  /// the first sample, whose torque_in_force is to be that torque.
  void hold(double torque);

  /// The wanted torque (N m) at this sample.
  /// @param reference reference in counts of the fine encoder. @param motion motion of the reference before
  /// it is rounded to counts.
  /// @param torque_in_force the torque decided at the last sample, N m; 0 before the first. A torque of the
  /// DAC, hence within its range.
  /// @param new_target the target differs from that of the last update.
  /// @param sample number of the sample from the start of the trial.
  double update(std::int64_t reference, const EncoderReading& reading, double torque_in_force,
                const ReferenceMotion& motion = {}, bool new_target = false, std::int64_t sample = 0);

  ControlPhase phase() const { return switch_.phase(); }            ///< Phase of the last sample.
  std::int64_t phase_changes() const { return switch_.changes(); }  ///< Number of phase changes so far.
  double integral() const;  ///< Integral I of the phase (coarse or fine) of the last sample, N m

 private:
  double count_of(EncoderChoice encoder, const EncoderReading& reading) const;

  bool two_phases_;
  EncoderChoice fine_encoder_;    ///< Encoder that closes the loop in the fine phase.
  EncoderChoice coarse_encoder_;  ///< Encoder that closes the loop in the coarse phase.
  bool velocity_by_other_;  ///< The velocity loop of the fine phase reads the encoder on the other mass.
  double fine_per_coarse_;
  ControlChain fine_;    ///< Blocks of the fine phase.
  ControlChain coarse_;  ///< Blocks of the coarse phase.
  PhaseSwitch switch_;
};

}  // namespace zerocount::loop
