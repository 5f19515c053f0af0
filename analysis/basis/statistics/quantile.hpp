#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/sums/histogram.hpp"

namespace zerocount::statistics {

/// Rank of the sample quantile among the sorted observations, from 1: ⌈n·p⌉, at least 1; 0 if n is 0.
/// `probability` p in (0, 1).
///
/// A product n·p that is just above a whole number because of rounding is taken as that number.
std::int64_t quantile_rank(std::int64_t observations, double probability);

/// Ranks of the two observations that bound a quantile.
struct RankBounds {
  std::int64_t low{0};  ///< Rank of the lower bound, from 1; 0: too few observations for a lower bound.
  /// Rank of the upper bound; observations + 1: too few observations for an upper bound.
  std::int64_t high{0};
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
  double value{0.0};  ///< Sample quantile; NaN for an empty histogram.
  double low{0.0};    ///< Lower confidence bound; NaN if there are too few observations for it.
  double high{0.0};   ///< Upper confidence bound; NaN if there are too few observations for it.
};

/// The sample quantile by the inverse of the empirical distribution function: the smallest observation x such
/// that a proportion of at least p of the observations is ≤ x (definition 1 of Hyndman and Fan, Amer.
/// Statist. 50 (1996) 361; numpy's method "inverted_cdf"). It is always one of the observations, so a
/// settling time stays a whole number of samples.
template <typename Value>
Quantile quantile(const Histogram<Value>& histogram, double probability,
                  double confidence = summary_confidence) {
  const RankBounds bounds = quantile_rank_bounds(histogram.size, probability, confidence);
  return {order_statistic(histogram, quantile_rank(histogram.size, probability)),
          order_statistic(histogram, bounds.low), order_statistic(histogram, bounds.high)};
}

/// The `rank`-th smallest of n values, rank = 1 … n.
double order_statistic(std::vector<double> values, std::int64_t rank);

/// The sample quantile of n ≥ 1 values in any order: the value of rank quantile_rank().
double sample_quantile(std::vector<double> values, double probability);

/// The sample quantile of n ≥ 1 sorted values at `probability` p, interpolated linearly between the order
/// statistics with the ranks on either side of p·(n + 1) (definition 6 of Hyndman and Fan). It suits errors
/// in resamples, whose order statistics have the mean probability k/(n + 1). If one of the two order
/// statistics is infinite, the one with the larger magnitude is taken.
double interpolated_quantile(std::span<const double> sorted, double probability);

/// The upper median: the value of rank ⌊n/2⌋ + 1 of n ≥ 1 values.
inline double upper_median(std::vector<double> values) {
  const std::int64_t rank = std::ssize(values) / 2 + 1;
  return order_statistic(std::move(values), rank);
}

}  // namespace zerocount::statistics
