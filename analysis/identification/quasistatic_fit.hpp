#pragma once

#include <span>
#include <vector>

#include "analysis/identification/contact_coordinates.hpp"
#include "analysis/identification/starting_point.hpp"
#include "analysis/identification/test_record.hpp"

namespace zerocount::identification {

/// Elongation (rad) of the spring after each of the torques (N m), beginning unloaded and virgin. Reversals
/// are remembered and loops close: Masing's rules with the branch law f(d) = k1·d + k2/β·(1 − exp(−β·d)).
std::vector<double> spring_elongations(std::span<const double> torques,
                                       const friction::FrictionParameters& friction);

/// A point fitted to slow parts.
struct SlowFit {
  ContactPoint point;
  double squares{0.0};  ///< sum of squares, in units of the readings
};

/// Least squares of the law without inertia and damping on the slow branches and the later halves of holds:
/// k1, k2 and β, the best of several starting values of β. It takes milliseconds, and its minimum does not
/// depend on inertia and damping, which such parts show little of. The creep law is that of `start`, for a
/// spring that always carries the applied torque. At most some thousand samples of a record are used, evenly
/// chosen.
/// @param free coordinates that may change
/// @returns `start` with the fitted coordinates; `start` itself and infinity if there are no slow branches.
SlowFit fit_slow_parts(std::span<const TestRecord> records, const ContactPoint& start, double creep_torque,
                       const FreeCoordinates& free);

}  // namespace zerocount::identification
