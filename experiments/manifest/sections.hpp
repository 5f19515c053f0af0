#pragma once

#include "experiments/manifest/checks.hpp"
#include "experiments/manifest/values.hpp"

namespace zerocount {

/// Reads the sections of parameters below `root`, the whole manifest, maps inside one another as far as the
/// names of parameters go: the plan's list, its sequence and its base values, and where they stand. What is
/// not written has its default.
void read_sections(const Field& root, Reading& reading, PlanPlaces& places);

}  // namespace zerocount
