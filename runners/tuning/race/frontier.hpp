#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runners/tuning/race/candidate.hpp"

namespace zerocount::tuning {

/// A point that the search has simulated.
struct TriedPoint {
  Values values;
  Estimate estimate;  ///< by the most units that it was given
};

/// The frontier between success and speed: the points with at least `units` units that no other one of them
/// beats in both the rate and the criterion, the fastest first.
std::vector<TriedPoint> frontier_of(std::span<const TriedPoint> tried, std::int64_t units);

}  // namespace zerocount::tuning
