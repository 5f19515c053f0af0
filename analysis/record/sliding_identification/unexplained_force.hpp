#pragma once

#include <string>
#include <vector>

#include "experiments/parameters/study_units.hpp"

namespace zerocount::sliding_identification {

struct SlidingFit;

/// The simulated motion of the identified axis under the whole torque of a record, beside the readings.
struct FreeRun {
  std::string name;  ///< Name of the record.
  parameters::AxisKind axis{};
  double start{0.0};     ///< Time in the record at which the simulation starts, s.
  double duration{0.0};  ///< Duration of the simulation, s.
  /// Root mean square of simulated minus read positions, rad or m; NaN if the simulation became non-finite.
  double rms{0.0};
  double max{0.0};     ///< Largest difference between simulated and read position, rad or m.
  double stroke{0.0};  ///< Travel of the record: largest minus smallest reading, rad or m.
};

/// Simulates each record in one run, from the fitted state at the first sample of its first window on,
/// through reversals and standstills, to its end.
///
/// The axis is core's Plant with the law `coulomb` and the offset as a constant torque. What the law lacks
/// adds up: a force that is wrong by ΔF moves the axis by ΔF/cs each second, until it rests. The readings are
/// not used after the start.
std::vector<FreeRun> free_runs(const SlidingFit& fit);

struct SlidingFit;

/// How well a quantity, such as the position, predicts the torque that the sliding law leaves unexplained.
struct RepeatingForce {
  /// Predicting quantity: "position", "position and direction", "speed and direction" or "acceleration".
  std::string with;
  /// Proportion of the variance of the unexplained torque that is predicted by the class means over the other
  /// strokes. At most 1; 0 or negative if the torque does not repeat.
  double predicted{0.0};
  /// Smallest mean unexplained torque against the drive in a class of windows with similar values of the
  /// quantity, among classes with windows of several strokes, N m or N.
  double low{0.0};
  /// Largest mean unexplained torque against the drive in a class of windows with similar values of the
  /// quantity, among classes with windows of several strokes, N m or N.
  double high{0.0};
};

/// The quantities (position, speed, …) with which the unexplained torque of the windows repeats. The windows
/// are divided into classes of ten equal parts of the quantity's range; if the name says so, each direction
/// separately.
///
/// Windows of one stroke depend on each other, so the variance within a sample says nothing. Each window is
/// predicted by the mean of its class over all *other strokes*: predicted = 1 − Σ(r − r̂)²/Σ(r − r̄)², with
/// r̄ the mean over all windows of other strokes. Classes that occur in one stroke only are predicted by r̄.
/// Empty with a single stroke.
std::vector<RepeatingForce> repeating_forces(const SlidingFit& fit);

}  // namespace zerocount::sliding_identification
