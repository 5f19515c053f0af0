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

/// What the rates of the points of a search tell of the values between them.
struct Landscape {
  std::int64_t points{0};  ///< that were simulated
  /// Points at which some moves meet the worst goal for sure, more than 1 % of them, and fewer than it asks.
  std::int64_t telling{0};
  /// Whether more moves meet it at one point than at another for sure: moves that are trivial meet it at all.
  bool varies{false};

  /// Whether the rates led somewhere: they vary, and at least ten points, and one in twenty, are telling.
  /// Where the rate is the same nearly everywhere, 0 or another, no point tells where to go, and a narrow
  /// range of good values may lie between them.
  bool leads() const;
};

Landscape landscape_of(const Aim& aim, std::span<const TriedPoint> tried);

/// What a search shows whose best values miss the goal in their proof.
struct MissedSearch {
  bool approaching{false};  ///< SearchResult::approaching
  bool all_tried{true};     ///< ProvenFinalist::all_tried
  Landscape landscape{};

  /// Whether the goal is out of reach in the ranges, as far as simulation can tell: the search followed rates
  /// that rise, it came no nearer at the end, and nothing that it found may meet the goal.
  bool shows_unreachable() const { return landscape.leads() && !approaching && all_tried; }
};

}  // namespace zerocount::tuning
