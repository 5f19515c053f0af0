#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/statistics/unknown.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/sequence.hpp"

/// Accuracy and repeatability of positioning after ISO 230-2:2014, "Test code for machine tools – Part 2:
/// Determination of accuracy and repeatability of positioning of numerically controlled axes".
///
/// Each of m target positions i is approached n times from either side: in positive direction (↑) and in
/// negative direction (↓). The deviation x_ij is the position reached in cycle j less the target position.
/// With the clauses of the standard (2.10 to 2.24 in the edition of 2006, in the same order):
///
///     3.13  x̄i↑ = (1/n)·Σj x_ij↑                              mean unidirectional deviation at a position
///     3.14  x̄i  = (x̄i↑ + x̄i↓)/2                               mean bidirectional deviation at a position
///     3.15  Bi  = x̄i↑ − x̄i↓                                   reversal value at a position
///     3.16  B   = max|Bi|                                     reversal value of the axis
///     3.17  B̄   = (1/m)·Σi Bi                                 mean reversal value of the axis
///     3.18  si↑ = √(Σj (x_ij↑ − x̄i↑)²/(n − 1))                estimator of the standard uncertainty
///     3.19  Ri↑ = 4·si↑                                       unidirectional repeatability at a position
///     3.20  Ri  = max(2·si↑ + 2·si↓ + |Bi|, Ri↑, Ri↓)         bidirectional repeatability at a position
///     3.21  R↑  = max Ri↑                                     unidirectional repeatability of the axis
///     3.22  R   = max Ri                                      bidirectional repeatability of the axis
///     3.23  E↑  = max x̄i↑ − min x̄i↑                           unidirectional systematic deviation
///     3.24  E   = max(x̄i↑, x̄i↓) − min(x̄i↑, x̄i↓)               bidirectional systematic deviation
///     3.25  M   = max x̄i − min x̄i                             mean bidirectional deviation of the axis
///     3.26  A↑  = max(x̄i↑ + 2·si↑) − min(x̄i↑ − 2·si↑)         unidirectional accuracy
///     3.27  A   = max(x̄i↑ + 2·si↑, x̄i↓ + 2·si↓) − min(x̄i↑ − 2·si↑, x̄i↓ − 2·si↓)  bidirectional accuracy
///
/// max and min are over all targets; what has ↑ is defined alike with ↓. Numbers 3.13 to 3.17 and 3.23 to
/// 3.25 are by their order between the others, which clause 6.2 cites. The standard's test has n = 5. With n
/// = 1 (clause 6.2, for long axes) the values that need an si do not exist, the others do; if there are
/// approaches from one side only, the unidirectional values of that side are all there is.
namespace zerocount::iso230 {

/// The deviations at one target, any unit.
struct TargetDeviations {
  /// [cycle] x_ij↑; empty if the target is not approached in positive direction.
  std::vector<double> positive;
  /// [cycle] x_ij↓; empty if the target is not approached in negative direction.
  std::vector<double> negative;
};

/// The quantities of the standard for one target, in the unit of the deviations; NaN if a quantity is not
/// defined.
struct TargetRepeatability {
  double mean_positive{statistics::unknown};           ///< x̄i↑
  double mean_negative{statistics::unknown};           ///< x̄i↓
  double mean{statistics::unknown};                    ///< x̄i
  double reversal{statistics::unknown};                ///< Bi
  double uncertainty_positive{statistics::unknown};    ///< si↑
  double uncertainty_negative{statistics::unknown};    ///< si↓
  double repeatability_positive{statistics::unknown};  ///< Ri↑
  double repeatability_negative{statistics::unknown};  ///< Ri↓
  double repeatability{statistics::unknown};           ///< Ri
};

/// The quantities of the standard for the axis, in the unit of the deviations. NaN if a quantity is not
/// defined, which is so if it is undefined for one of the targets.
struct AxisRepeatability {
  double reversal{statistics::unknown};                ///< B
  double mean_reversal{statistics::unknown};           ///< B̄, signed
  double repeatability_positive{statistics::unknown};  ///< R↑
  double repeatability_negative{statistics::unknown};  ///< R↓
  double repeatability{statistics::unknown};           ///< R
  double systematic_positive{statistics::unknown};     ///< E↑
  double systematic_negative{statistics::unknown};     ///< E↓
  double systematic{statistics::unknown};              ///< E
  double mean_bidirectional{statistics::unknown};      ///< M
  double accuracy_positive{statistics::unknown};       ///< A↑
  double accuracy_negative{statistics::unknown};       ///< A↓
  double accuracy{statistics::unknown};                ///< A
};

struct Repeatability {
  AxisRepeatability axis;
  std::vector<TargetRepeatability> targets;  ///< [target] Quantities of the target.
};

/// The values of one run of the test, by the formulas above. Equal deviations at a target that are whole
/// numbers, such as counts, give an si of exactly 0.
Repeatability repeatability_of(std::span<const TargetDeviations> targets);

/// Numbers of targets and approaches in a sequence of moves.
struct SequenceShape {
  std::int64_t targets{0};  ///< Number of targets in the list of the sequence.
  /// Smallest number of approaches of a target from any side from which targets are approached.
  std::int64_t cycles{0};
  bool positive{false};  ///< True if there are approaches from below.
  bool negative{false};  ///< True if there are approaches from above.
};

SequenceShape shape_of(std::span<const study::SequenceMove> sequence);

/// A trial as one run of the test of ISO 230-2, seen in two ways, and from each of two masses.
///
/// The deviation of a move from its target of p counts is, by the true position, θ − (p + ½ − φ)·Δx in rad,
/// with θ of a mass at the last sample, and φ the phase and Δx the resolution of the fine encoder that closes
/// the loop: from the middle of the target's count. By the encoder it is its fine count at the last sample
/// less p, in counts.
struct TrialRepeatability {
  /// Values from the true position of the mass whose encoder closes the loop, rad.
  Repeatability from_position;
  Repeatability from_encoder;  ///< Values from the encoder, counts.
  Repeatability of_motor;      ///< Values from the true position of the motor, rad.
  /// Values from the true position of the load, rad; of the motor if there is one mass.
  Repeatability of_load;
};

/// The targets of a trial in the order of their list, counts.
std::vector<double> listed_targets(std::span<const study::SequenceMove> sequence,
                                   const trial::TrialParameters& parameters);

/// The repeatability of one trial. Every move to a target counts as it ended, whether it arrived or not.
/// Nothing if the motion became non-finite in any move.
/// @throws Failure (bad_data) if the numbers of moves and of elements of the sequence differ.
std::optional<TrialRepeatability> trial_repeatability(std::span<const study::SequenceMove> sequence,
                                                      const trial::TrialParameters& parameters,
                                                      std::span<const trial::MoveOutcome> moves);

}  // namespace zerocount::iso230
