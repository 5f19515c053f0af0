#pragma once

#include <limits>
#include <span>

#include "analysis/identification/contact_coordinates.hpp"
#include "analysis/identification/starting_values/starting_point.hpp"
#include "analysis/record_fit/test_record.hpp"

namespace zerocount::identification {

/// A point fitted to slow parts.
struct SlowFit {
  ContactPoint point;
  double squares{std::numeric_limits<double>::infinity()};  ///< sum of squares, in units of the readings
};

/// Whether the slow parts show the creep law, or keep that of the start.
enum class SlowCreep { kept, fitted };

/// Least squares of the law without inertia and damping on the slow branches and the later halves of holds:
/// the spring and its creep, for a spring that always carries the applied torque. It takes a fraction of a
/// second, and its minimum does not depend on inertia and damping, which such parts show little of. The
/// spring is fitted first, from the nine best of `starts` with nine values of β each; from the two best of
/// these all six coordinates. At most some thousand samples of a record are used, evenly chosen.
/// @param free coordinates that may change
/// @returns the first start with the fitted coordinates; it itself and infinity if there are no slow
/// branches.
SlowFit fit_slow_parts(Records records, std::span<const ContactPoint> starts, double creep_torque,
                       const FreeCoordinates& free, SlowCreep creep);

}  // namespace zerocount::identification
