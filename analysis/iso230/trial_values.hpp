#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/iso230/repeatability.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::iso230 {

/// The measurements of a sequence of moves.
struct SequenceShape {
  std::int64_t targets{0};  ///< in its list
  std::int64_t cycles{0};   ///< fewest approaches of a target from a side from which any is approached
  bool positive{false};     ///< there are approaches from below
  bool negative{false};     ///< there are approaches from above
};

SequenceShape shape_of(std::span<const study::SequenceMove> sequence);

/// A trial as one run of the test of ISO 230-2, seen in two ways.
///
/// The deviation of a move from its target of p counts is, by the true position, θ − (p + ½ − φ)·Δx in rad,
/// with θ at the last sample, φ the encoder's phase and Δx the fine encoder's resolution: from the middle of
/// the target's count. By the encoder it is its fine count at the last sample less p, in counts.
struct TrialRepeatability {
  Repeatability from_position;  ///< rad
  Repeatability from_encoder;   ///< counts
};

/// The targets of a trial in the order of their list, counts.
std::vector<double> listed_targets(std::span<const study::SequenceMove> sequence,
                                   const trial::TrialParameters& parameters);

/// The repeatability of one trial. Every move to a target counts as it ended, whether it arrived or not, but
/// where the motion of any move was lost (nonfinite) there is nothing to measure: empty.
/// @throws Failure (bad_data) where moves and sequence are not of the same number.
std::optional<TrialRepeatability> trial_repeatability(std::span<const study::SequenceMove> sequence,
                                                      const trial::TrialParameters& parameters,
                                                      std::span<const trial::MoveOutcome> moves);

}  // namespace zerocount::iso230
