#include "analysis/statistics/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/statistics/distributions.hpp"

namespace zerocount::statistics {

std::int64_t quantile_rank(std::int64_t observations, double probability) {
  require_open_unit("quantile's probability", probability);
  if (observations == 0) return 0;
  constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
  const double product = static_cast<double>(observations) * probability;
  const auto rank = static_cast<std::int64_t>(std::ceil(product * (1.0 - rounding)));
  return std::clamp<std::int64_t>(rank, 1, observations);
}

RankBounds quantile_rank_bounds(std::int64_t observations, double probability, double confidence) {
  require_open_unit("quantile's probability", probability);
  require_confidence(confidence);
  const std::int64_t n = observations;
  const double tail = 0.5 * (1.0 - confidence);
  // low − 1 is the last k with P(B ≤ k) ≤ tail, so low is the first k with P(B ≤ k) > tail.
  const std::int64_t low =
      first_where(0, n, [&](std::int64_t k) { return binomial_cdf(n, probability, k) > tail; });
  // high − 1 is the first k with P(B > k) ≤ tail.
  const std::int64_t high =
      1 + first_where(0, n, [&](std::int64_t k) { return binomial_upper_tail(n, probability, k) <= tail; });
  return {low, high};
}

}  // namespace zerocount::statistics
