#pragma once

#include <cstdint>
#include <optional>

#include "core/loop/controller/control_block.hpp"
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
  PhaseSwitch(const CoarsePhaseParameters& rule, double sample_rate);

  /// Decides the phase of this sample.
  /// @param fine, coarse readings of the encoders of the two phases.
  /// @returns whether the phase has changed.
  bool update(const Feedback& fine, const Feedback& coarse);

  ControlPhase phase() const { return phase_; }      ///< of the last sample
  std::int64_t changes() const { return changes_; }  ///< in both directions, so far

 private:
  ControlPhase next_phase(const Feedback& fine) const;

  CoarsePhaseParameters rule_;
  double dwell_;  ///< D, which may be more than any number of samples
  ControlPhase phase_{ControlPhase::fine};
  std::int64_t changes_{0};
  std::int64_t settled_{0};  ///< successive samples that meet the condition of the fine phase
  std::optional<double> last_coarse_count_{};  ///< none before the first sample
};

}  // namespace zerocount::loop
