#pragma once

#include "experiments/manifest/checks.hpp"
#include "experiments/manifest/values.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::manifest {

/// Checks that the encoder sees each commanded motion of the assembled study. One of which not a count is
/// left is no motion for the loop, and would count as perfect: a target in SI units that differs from the
/// position before it and is the same count, and a sine reference of less than half a count.
///
/// An error where this is so in all trials of a design point (a warning if the study was recorded earlier); a
/// warning with their proportion where it is so in some.
void check_unseen_motions(const study::Study& study, const PlanPlaces& places, Reading& reading);

}  // namespace zerocount::manifest
