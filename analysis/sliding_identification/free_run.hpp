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

}  // namespace zerocount::sliding_identification
