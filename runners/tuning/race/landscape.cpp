#include "runners/tuning/race/landscape.hpp"

#include <cmath>

#include "analysis/statistics/proportion.hpp"

namespace zerocount::tuning {
namespace {

constexpr double hardly_any = 0.01;  // of the moves
constexpr double confidence = 0.95;  // of the bound of a point's rate
constexpr std::int64_t fewest = 10;  // telling points: single ones are there by chance
constexpr std::int64_t one_in = 20;  // of all points

bool is_telling(const Aim& aim, const Estimate& estimate) {
  if (estimate.units == 0 || !(estimate.rate < wanted_rate(aim.claims[estimate.worst]))) return false;
  // The moves of a unit may depend on each other: a unit counts once.
  const auto met =
      static_cast<std::int64_t>(std::floor(estimate.moves * static_cast<double>(estimate.units)));
  return statistics::clopper_pearson(met, estimate.units, confidence).low > hardly_any;
}

}  // namespace

bool Landscape::leads() const {
  return telling >= fewest && telling * one_in >= points;
}

Landscape landscape_of(const Aim& aim, std::span<const TriedPoint> tried) {
  Landscape landscape{.points = std::ssize(tried)};
  for (const TriedPoint& one : tried) landscape.telling += is_telling(aim, one.estimate) ? 1 : 0;
  return landscape;
}

}  // namespace zerocount::tuning
