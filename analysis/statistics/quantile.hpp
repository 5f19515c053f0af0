#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/statistics/histogram.hpp"
#include "analysis/statistics/proportion.hpp"

namespace zerocount::statistics {

/// The smallest number from `low` on, below `end`, for which `holds`, by bisection; `end` if there is none.
/// `holds` must be monotonic: false, then true.
template <typename Predicate>
std::int64_t first_where(std::int64_t low, std::int64_t end, const Predicate& holds) {
  while (low < end) {
    const std::int64_t middle = low + (end - low) / 2;
    if (holds(middle)) {
      end = middle;
    } else {
      low = middle + 1;
    }
  }
  return end;
}

/// Rank of the sample quantile: ⌈n·p⌉, at least 1; 0 if n is 0. `probability` p in (0, 1).
///
/// A product n·p that is just above a whole number because of rounding is taken as that number.
std::int64_t quantile_rank(std::int64_t observations, double probability);

/// Ranks of the two observations that bound a quantile.
struct RankBounds {
  std::int64_t low{0};   ///< 0: too few observations for a lower bound
  std::int64_t high{0};  ///< observations + 1: too few observations for an upper bound
};

/// Distribution-free confidence bounds of the quantile of `probability` p by order statistics.
///
/// With B binomial (n, p), low is the largest l with P(B ≤ l − 1) ≤ tail and high the smallest u with P(B ≥
/// u) ≤ tail, tail = (1 − confidence)/2. The observations of these ranks enclose the true quantile with at
/// least the stated probability for every distribution, including discrete ones. Source: David and Nagaraja,
/// Order Statistics, section 7.1.
RankBounds quantile_rank_bounds(std::int64_t observations, double probability,
                                double confidence = summary_confidence);

/// A sample quantile with its bounds, in the values' unit.
struct Quantile {
  double value{0.0};  ///< NaN of an empty histogram
  double low{0.0};    ///< NaN if there are too few observations for a bound
  double high{0.0};   ///< likewise
};

/// The sample quantile by the inverse of the empirical distribution function: the smallest observation x such
/// that a proportion of at least p of the observations is ≤ x (definition 1 of Hyndman and Fan 1996; numpy's
/// method "inverted_cdf"). It is always one of the observations, so a settling time stays a whole number of
/// samples.
template <typename Value>
Quantile quantile(const Histogram<Value>& histogram, double probability,
                  double confidence = summary_confidence) {
  const RankBounds bounds = quantile_rank_bounds(histogram.size, probability, confidence);
  return {order_statistic(histogram, quantile_rank(histogram.size, probability)),
          order_statistic(histogram, bounds.low), order_statistic(histogram, bounds.high)};
}

/// The upper median: the value of rank ⌊n/2⌋ + 1 of n ≥ 1 values.
inline double upper_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace zerocount::statistics
