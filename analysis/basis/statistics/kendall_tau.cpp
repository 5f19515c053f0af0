#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/basis/statistics/change_point.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::statistics {
namespace {

/// Counts values by rank, so that the number of counted values below a rank takes O(log n) (binary indexed
/// tree, Fenwick 1994).
class RankCounter {
 public:
  explicit RankCounter(std::size_t ranks) : sums_(ranks + 1, 0) {}

  void add(std::size_t rank) {
    for (std::size_t i = rank + 1; i < sums_.size(); i += lowest_bit(i)) ++sums_[i];
  }
  std::int64_t below(std::size_t rank) const {
    std::int64_t sum = 0;
    for (std::size_t i = rank; i > 0; i -= lowest_bit(i)) sum += sums_[i];
    return sum;
  }

 private:
  static std::size_t lowest_bit(std::size_t i) { return i & (~i + 1); }
  std::vector<std::int64_t> sums_;
};

}  // namespace

RankTrend& RankTrend::operator+=(const RankTrend& other) {
  rising += other.rising;
  falling += other.falling;
  equal += other.equal;
  return *this;
}

RankTrend rank_trend(std::span<const double> series) {
  std::vector<double> ordered(series.begin(), series.end());
  std::sort(ordered.begin(), ordered.end());
  ordered.erase(std::unique(ordered.begin(), ordered.end()), ordered.end());

  RankTrend trend;
  RankCounter seen(ordered.size());
  std::int64_t earlier = 0;
  for (const double value : series) {
    const auto rank =
        static_cast<std::size_t>(std::lower_bound(ordered.begin(), ordered.end(), value) - ordered.begin());
    const std::int64_t smaller = seen.below(rank);
    const std::int64_t larger = earlier - seen.below(rank + 1);
    trend.rising += smaller;
    trend.falling += larger;
    trend.equal += earlier - smaller - larger;
    seen.add(rank);
    ++earlier;
  }
  return trend;
}

double kendall_tau(const RankTrend& trend) {
  const std::int64_t pairs = trend.rising + trend.falling + trend.equal;
  if (pairs == 0) return unknown;
  return static_cast<double>(trend.rising - trend.falling) / static_cast<double>(pairs);
}

}  // namespace zerocount::statistics
