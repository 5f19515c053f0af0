#include "analysis/statistics/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <boost/math/distributions/binomial.hpp>

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
  const boost::math::binomial_distribution<double> below(static_cast<double>(n), probability);
  const auto at_most = [&](std::int64_t k) { return boost::math::cdf(below, static_cast<double>(k)); };
  const auto more_than = [&](std::int64_t k) {
    return boost::math::cdf(boost::math::complement(below, static_cast<double>(k)));
  };
  // low − 1 is the last k with P(B ≤ k) ≤ tail, so low is the first k with P(B ≤ k) > tail.
  const std::int64_t low = first_where(0, n, [&](std::int64_t k) { return at_most(k) > tail; });
  // high − 1 is the first k with P(B > k) ≤ tail.
  const std::int64_t high = 1 + first_where(0, n, [&](std::int64_t k) { return more_than(k) <= tail; });
  return {low, high};
}

}  // namespace zerocount::statistics
