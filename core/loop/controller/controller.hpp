#pragma once

#include <cstdint>
#include <optional>

#include "core/loop/controller/control_block.hpp"
#include "core/loop/controller/control_chain.hpp"
#include "core/loop/encoder.hpp"
#include "core/loop/parameters.hpp"

namespace zerocount::loop {

/// The rule by which a two-phase control changes its phase, by the readings of the present phase's encoder:
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

  ControlPhase phase() const { return phase_; }      ///< of the last sample
  std::int64_t changes() const { return changes_; }  ///< in both directions, so far

 private:
  ControlPhase next_phase(const Feedback& fine) const;

  CoarsePhaseParameters rule_;
  double dwell_;         ///< D, which may be more than any number of samples
  double first_change_;  ///< count_0 − count_{−1} of the coarse phase
  ControlPhase phase_{ControlPhase::fine};
  std::int64_t changes_{0};
  std::int64_t settled_{0};  ///< successive samples that meet the condition of the fine phase
  std::optional<double> last_coarse_count_{};  ///< none before the first sample
};

/// Whether the control has two phases: whether any error is beyond coarse_beyond.
bool has_coarse_phase(const ControllerParameters& parameters);

/// The gains and blocks of one phase of the control, as a control without phases. In the fine phase of a
/// two-phase control kd counts as 0 (paper, practical issue 5).
ControllerParameters controller_in_phase(ControllerParameters controller, ControlPhase phase);

/// The controller whose gains are those at standstill; empty without them.
std::optional<ControllerParameters> controller_at_standstill(ControllerParameters controller);

/// The blocks of a control without phases, away from their limits.
LinearChain linear_chain(const ControllerParameters& parameters, const EncoderParameters& encoders);

/// Range to which anti-windup clamps the integral. @param lowest, highest the DAC's range, N m.
TorqueRange integral_range(AntiWindup anti_windup, double lowest, double highest);

/// The control of the count: a chain of blocks, or one for each of two phases (PhaseSwitch), each fed back
/// from its own encoder; the coarse phase reads no encoder of the other mass. Errors and counts are fine
/// ones; a coarse encoder's count is taken times fine/coarse.
///
/// On a change of phase at sample k the new chain sets I to the torque in force; with blocks, to the torque
/// with which the chain gives the one in force in the steady state (ControlBlock::take_over). Its previous
/// error and count, e_{k−1} and count_{k−1}, are those of its own encoder. Without blocks the torque
/// therefore changes only by ki·(e_k + e_{k−1}) + kp·e_k − kd·(count_k − count_{k−1}).
class Controller {
 public:
  /// @param integral I before the first sample, N m, of the phase of that sample.
  /// @param start by which the counts before the first sample are known.
  Controller(const ControllerParameters& parameters, const EncoderParameters& encoders, double integral,
             const DacScale& dac, const StartOfMotion& start = {});

  /// Starts from the steady state in which the axis stands still under this torque (N m). To be called before
  /// the first sample, whose torque_in_force is to be that torque.
  void hold(double torque);

  /// The wanted torque (N m) at this sample.
  /// @param reference in counts of the fine encoder; its motion is that before it is rounded to them.
  /// @param torque_in_force the torque decided at the last sample, N m; 0 before the first. A torque of the
  /// DAC, hence within its range.
  /// @param new_target the target is not that of the last update.
  /// @param sample its number, from the trial's start.
  double update(std::int64_t reference, const EncoderReading& reading, double torque_in_force,
                const ReferenceMotion& motion = {}, bool new_target = false, std::int64_t sample = 0);

  ControlPhase phase() const { return switch_.phase(); }            ///< of the last sample
  std::int64_t phase_changes() const { return switch_.changes(); }  ///< so far
  double integral() const;                                          ///< I of the phase in force, N m

 private:
  double count_of(EncoderChoice encoder, const EncoderReading& reading) const;

  bool two_phases_;
  EncoderChoice fine_encoder_;    ///< of the fine phase
  EncoderChoice coarse_encoder_;  ///< of the coarse phase
  bool velocity_by_other_;        ///< of the fine phase
  double fine_per_coarse_;
  ControlChain fine_;    ///< of the fine phase
  ControlChain coarse_;  ///< of the coarse phase
  PhaseSwitch switch_;
};

}  // namespace zerocount::loop
