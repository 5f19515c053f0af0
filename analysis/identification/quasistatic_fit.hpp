#pragma once

#include <span>
#include <vector>

#include "analysis/identification/contact_coordinates.hpp"
#include "analysis/identification/starting_point.hpp"
#include "analysis/record_fit/test_record.hpp"

namespace zerocount::identification {

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
SlowFit fit_slow_parts(Records records, const ContactPoint& start, double creep_torque,
                       const FreeCoordinates& free);

}  // namespace zerocount::identification
