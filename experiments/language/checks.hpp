#pragma once

#include <vector>

#include "experiments/plan/plan.hpp"
#include "experiments/yaml/problems.hpp"

namespace zerocount {

/// Where the values of a plan stand in the manifest.
struct PlanPlaces {
  std::vector<Place> base;               ///< [slot]; that of the manifest's first line for a default
  std::vector<bool> written;             ///< [slot] whether the base value is written in the manifest
  std::vector<std::vector<Place>> axes;  ///< [axis][assignment]
};

/// Checks what no parameter can tell alone, at every design point, for all values that the distributions can
/// draw (their supports; a realised profile's limits): dwell and window at least one sample and at most the
/// hold; at most 10¹² samples a trial; |preload| below breakaway. A problem is reported at the value that the
/// sweep gives, where one of those involved is swept.
void check_points(const StudyPlan& plan, const PlanPlaces& places, Problems& problems);

}  // namespace zerocount
