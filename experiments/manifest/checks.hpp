#pragma once

#include <optional>
#include <span>
#include <vector>

#include "experiments/manifest/values.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/yaml/problems.hpp"

namespace zerocount::manifest {

/// Places of a plan's values in the manifest.
struct PlanPlaces {
  std::vector<yaml::Place> base;               ///< [slot]; for a default the manifest's first line
  std::vector<bool> written;                   ///< [slot] whether the base value is written in the manifest
  std::vector<std::vector<yaml::Place>> axes;  ///< [axis][assignment]
};

/// Checks that involve several parameters, at every design point and for all values that can be drawn: values
/// must be consistent (value_rules.hpp), every given key must have an effect at some point
/// (effect_rules.hpp), and required values must be given. A problem is reported at the
/// place of a swept value, if one is involved.
void check_points(const PlanPlaces& places, Reading& reading);

/// Whether the manifest gives the slot a value at every point.
bool is_given_everywhere(const PlanPlaces& places, const study::StudyPlan& plan, std::size_t slot);

/// Place in the manifest of the slot's value: outside the sweep, or the first one in it. Nothing if the
/// manifest does not give it.
std::optional<yaml::Place> given_place(const PlanPlaces& places, const study::StudyPlan& plan,
                                       std::size_t slot);

struct FaultPlace {
  yaml::Place place;
  std::size_t slot{0};  ///< whose value is there
};

/// Place in the manifest of one of the values that a fault at a design point involves: a swept one, otherwise
/// one that the manifest gives, otherwise the first.
FaultPlace place_of_fault(const PlanPlaces& places, const study::StudyPlan& plan,
                          std::span<const std::size_t> slots, std::size_t point);

}  // namespace zerocount::manifest
