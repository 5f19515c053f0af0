#pragma once

#include <cstdint>

#include "analysis/statistics/histogram.hpp"
#include "analysis/statistics/proportion.hpp"

namespace zerocount {

/// Rank of the sample quantile: ⌈n·p⌉, at least 1; 0 where n is 0. `probability` p in (0, 1).
///
/// A product n·p that rounding lifted just above a whole number counts as that number.
std::int64_t quantile_rank(std::int64_t observations, double probability);

/// Ranks of the two observations between which a quantile lies.
struct RankBounds {
  std::int64_t low{0};   ///< 0: no observation is a lower bound, there are too few
  std::int64_t high{0};  ///< observations + 1: none is an upper bound
};

/// Distribution-free confidence bounds of the quantile of `probability` p by order statistics.
///
/// With B binomial (n, p), low is the largest l with P(B ≤ l − 1) ≤ tail and high the smallest u with P(B ≥
/// u) ≤ tail, tail = (1 − confidence)/2. The observations of these ranks enclose the true quantile with at
/// least the stated probability whatever the distribution, discrete ones included. Source: David and
/// Nagaraja, Order Statistics, section 7.1.
RankBounds quantile_rank_bounds(std::int64_t observations, double probability,
                                double confidence = summary_confidence);

/// A sample quantile with its bounds, in the values' unit.
struct Quantile {
  double value{0.0};  ///< NaN of an empty histogram
  double low{0.0};    ///< NaN where there are too few observations for a bound
  double high{0.0};   ///< likewise
};

/// The sample quantile by the inverse of the empirical distribution function: the smallest observation x such
/// that a proportion of at least p of the observations is ≤ x (definition 1 of Hyndman and Fan 1996; numpy's
/// method "inverted_cdf"). Always one of the observations: a settling time stays a whole number of samples.
template <typename Value>
Quantile quantile(const Histogram<Value>& histogram, double probability,
                  double confidence = summary_confidence) {
  const RankBounds bounds = quantile_rank_bounds(histogram.size, probability, confidence);
  return {order_statistic(histogram, quantile_rank(histogram.size, probability)),
          order_statistic(histogram, bounds.low), order_statistic(histogram, bounds.high)};
}

}  // namespace zerocount
