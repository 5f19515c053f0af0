#pragma once

#include <cstdint>
#include <vector>

#include "analysis/summary/summary.hpp"

/// The best of several design points.
namespace zerocount::summary {

/// The points that have trials, the best first: by goal::merits_of(); among equals the one with fewer swept
/// parameters other than 0 or none; then the first. Points of an open-loop study keep their order.
std::vector<std::int64_t> points_by_merit(const StudySummary& summary);

/// The first of them.
std::int64_t best_point(const StudySummary& summary);

}  // namespace zerocount::summary
