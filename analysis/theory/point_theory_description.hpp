#pragma once

#include <string>

#include "analysis/document/description.hpp"
#include "analysis/theory/point_theory.hpp"

namespace zerocount::theory {

/// The theory of a design point: for data each range by itself, for people statements such as "(6) stable
/// below: 1.5e-04 N m/count". Loops are for data; people have a table of loop_description().
document::Description<PointTheory> point_theory_description();

/// A loop and its margins.
document::Description<LoopRanges> loop_description();

/// Why approach.exceeds_hold(), for a warning: continues "the loop's slowest time constant".
std::string slowness_text(const Approach& approach);

}  // namespace zerocount::theory
