#include "runners/tuning/race/frontier.hpp"

#include <algorithm>

namespace zerocount::tuning {

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

}  // namespace zerocount::tuning
