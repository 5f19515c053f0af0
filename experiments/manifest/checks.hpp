#pragma once

#include <vector>

#include "experiments/manifest/values.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/yaml/problems.hpp"

namespace zerocount {

/// Where the values of a plan stand in the manifest.
struct PlanPlaces {
  std::vector<Place> base;               ///< [slot]; that of the manifest's first line for a default
  std::vector<bool> written;             ///< [slot] whether the base value is written in the manifest
  std::vector<std::vector<Place>> axes;  ///< [axis][assignment]
};

/// Checks what no parameter can tell alone: at every design point, for all values that can be drawn, that
/// values fit one another (value_rules.hpp); and that no key is given that has no effect at any point
/// (effect_rules.hpp), and none is missing that has to be given (required_values.hpp). A problem is told at
/// the value that the sweep gives, where one of those involved is swept.
void check_points(const PlanPlaces& places, Reading& reading);

}  // namespace zerocount
