#include "analysis/basis/statistics/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/basis/statistics/distributions.hpp"
#include "core/numerics/roots.hpp"

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
      numerics::first_where(0, n, [&](std::int64_t k) { return binomial_cdf(n, probability, k) > tail; });
  // high − 1 is the first k with P(B > k) ≤ tail.
  const std::int64_t high = 1 + numerics::first_where(0, n, [&](std::int64_t k) {
                              return binomial_upper_tail(n, probability, k) <= tail;
                            });
  return {low, high};
}

double order_statistic(std::vector<double> values, std::int64_t rank) {
  const auto place = values.begin() + (rank - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

double sample_quantile(std::vector<double> values, double probability) {
  const std::int64_t rank = quantile_rank(std::ssize(values), probability);
  return order_statistic(std::move(values), rank);
}

double interpolated_quantile(std::span<const double> sorted, double probability) {
  const double place = probability * static_cast<double>(sorted.size() + 1) - 1.0;
  if (place <= 0.0) return sorted.front();
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 >= sorted.size()) return sorted.back();
  if (std::isinf(sorted[below]) || std::isinf(sorted[below + 1])) {
    return std::abs(sorted[below]) > std::abs(sorted[below + 1]) ? sorted[below] : sorted[below + 1];
  }
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[below + 1] - sorted[below]);
}

}  // namespace zerocount::statistics
