#pragma once

#include <cstdint>
#include <span>

namespace zerocount::statistics {

/// Numbers of rising, falling and equal pairs of a series.
struct RankTrend {
  std::int64_t rising{0};   ///< pairs whose later value is the larger
  std::int64_t falling{0};  ///< pairs whose later value is the smaller
  std::int64_t equal{0};    ///< pairs of equal values

  RankTrend& operator+=(const RankTrend& other);

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.rising, self.falling, self.equal);
  }
};

/// Counts the pairs of a series in O(n log n) time. rising − falling is the Mann–Kendall statistic S:
/// positive if the series tends to rise. Both signs are equally likely if the order of the values is random.
/// Values must not be NaN. Source: Mann (1945); Kendall, Rank Correlation Methods.
RankTrend rank_trend(std::span<const double> series);

/// Kendall's τ_a = (rising − falling)/pairs, in [−1, 1]; NaN where there are no pairs.
double kendall_tau(const RankTrend& trend);

}  // namespace zerocount::statistics
