#include "runners/tuning/race/tried_points.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/proportion.hpp"

namespace zerocount::tuning {
namespace {

constexpr double hardly_any = 0.01;  // of the moves
constexpr double confidence = 0.95;  // of the bounds of a point's rate
constexpr std::int64_t fewest = 10;  // telling points: single ones are there by chance
constexpr std::int64_t one_in = 20;  // of all points

/// Of the moves that meet the worst goal. The moves of a unit may depend on each other: a unit counts once.
statistics::ConfidenceInterval bounds_of(const Estimate& estimate) {
  const auto met =
      static_cast<std::int64_t>(std::floor(estimate.moves * static_cast<double>(estimate.units)));
  return statistics::clopper_pearson(met, estimate.units, confidence);
}

bool is_telling(const Aim& aim, const Estimate& estimate) {
  return estimate.units > 0 && estimate.rate < wanted_rate(aim.claims[estimate.worst]) &&
         bounds_of(estimate).low > hardly_any;
}

}  // namespace

std::vector<TriedPoint> frontier_of(std::span<const TriedPoint> tried, std::int64_t units) {
  std::vector<TriedPoint> points;
  std::ranges::copy_if(tried, std::back_inserter(points),
                       [units](const TriedPoint& one) { return one.estimate.units >= units; });
  std::ranges::stable_sort(points, [](const TriedPoint& a, const TriedPoint& b) {
    if (a.estimate.criterion != b.estimate.criterion) return a.estimate.criterion < b.estimate.criterion;
    return a.estimate.rate > b.estimate.rate;
  });
  std::vector<TriedPoint> frontier;
  for (TriedPoint& one : points) {
    if (frontier.empty() || one.estimate.rate > frontier.back().estimate.rate)
      frontier.push_back(std::move(one));
  }
  return frontier;
}

bool Landscape::leads() const {
  return varies && telling >= fewest && telling * one_in >= points;
}

Landscape landscape_of(const Aim& aim, std::span<const TriedPoint> tried) {
  Landscape landscape{.points = std::ssize(tried)};
  double highest = 0.0, lowest = 1.0;
  for (const TriedPoint& one : tried) {
    landscape.telling += is_telling(aim, one.estimate) ? 1 : 0;
    if (one.estimate.units == 0) continue;
    const statistics::ConfidenceInterval bounds = bounds_of(one.estimate);
    highest = std::max(highest, bounds.low);
    lowest = std::min(lowest, bounds.high);
  }
  landscape.varies = highest > lowest;
  return landscape;
}

}  // namespace zerocount::tuning
