#pragma once

#include <string>
#include <vector>

#include "experiments/parameters/study_units.hpp"

namespace zerocount::sliding_identification {

struct SlidingFit;

/// The simulated motion of the identified axis under the whole torque of a record, beside the readings.
struct FreeRun {
  std::string name;  ///< of the record
  parameters::AxisKind axis{};
  double start{0.0};     ///< time of the record at which it begins, s
  double duration{0.0};  ///< s
  double rms{0.0};     ///< root mean square of simulated less read positions, rad or m; NaN where it is lost
  double max{0.0};     ///< largest difference, rad or m
  double stroke{0.0};  ///< largest less smallest reading, rad or m
};

/// Simulates each record without a restart, from the state that the fit found at the first sample of its
/// first window on, through reversals and standstills, to its end.
///
/// The axis is core's Plant with the law `coulomb` and the offset as a constant torque. What the law lacks
/// adds up: a force that is wrong by ΔF moves the axis by ΔF/cs each second, until it rests. The readings are
/// not used after the start.
std::vector<FreeRun> free_runs(const SlidingFit& fit);

struct SlidingFit;

/// How far the torque that the law leaves unexplained repeats with something.
struct RepeatingForce {
  std::string with;  ///< "position", "position and direction", "speed and direction", "acceleration"
  /// Part of its variance that the means over the other strokes predict; at most 1, 0 or negative where it
  /// does not repeat.
  double predicted{0.0};
  double low{0.0};   ///< smallest and largest mean over a class with windows of several strokes, N m or N,
  double high{0.0};  ///< as a torque against the drive
};

/// What the unexplained torque of the windows repeats with: classes of ten equal parts of the range, each
/// direction apart where it is said.
///
/// Windows of one stroke depend on each other, so the variance within a sample says nothing. Each window is
/// predicted by the mean of its class over all *other strokes*; predicted = 1 − Σ(r − r̂)²/Σ(r − r̄)² with r̄
/// the mean over all windows of other strokes. Classes that one stroke alone has are predicted by r̄. Empty
/// with a single stroke.
std::vector<RepeatingForce> repeating_forces(const SlidingFit& fit);

}  // namespace zerocount::sliding_identification
