#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/proportion.hpp"
#include "analysis/tally.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount {

/// A sample as its distinct values, each with how often it occurred.
struct WeightedSample {
  std::vector<double> values;
  std::vector<std::int64_t> counts;  ///< [value], each positive
};

template <typename Value>
WeightedSample weighted_sample(const Tally<Value>& tally) {
  WeightedSample sample;
  for (const auto& [value, count] : tally.counts) {
    sample.values.push_back(static_cast<double>(value));
    sample.counts.push_back(count);
  }
  return sample;
}

inline constexpr std::int64_t bootstrap_resamples = 2000;

/// The means of `resamples` samples of the same size n, drawn from the sample with replacement, in the order
/// of their numbers.
///
/// Resample r draws from the random numbers with the index r, whatever the others do. How often each of the K
/// distinct values occurs is multinomial: n draws where n ≤ 16·K, otherwise a binomial number for one value
/// after the other, so that the time is that of 2000·min(n, 16·K) draws. A million settling times with a
/// thousand distinct values take a second; a million distinct values would take half a minute.
std::vector<double> bootstrap_means(const WeightedSample& sample, const RandomStream& stream,
                                    std::int64_t resamples = bootstrap_resamples);

/// The acceleration of the mean, from the jackknife: leaving out xᵢ changes the mean by (x̄ − xᵢ)/(n − 1), so
///
///   a = Σ(xᵢ − x̄)³/(6·(Σ(xᵢ − x̄)²)^(3/2)).
double mean_acceleration(const WeightedSample& sample);

/// Bias-corrected and accelerated (BCa) bootstrap interval of the mean, in the values' unit: with z the
/// normal quantile of (1 ∓ confidence)/2, z₀ that of the share of resampled means below the mean (those equal
/// to it count half), and a the acceleration, the quantiles of the resampled means for the probabilities
///
///   Φ(z₀ + (z₀ + z)/(1 − a·(z₀ + z))).
///
/// Covers the mean with the stated probability up to O(1/n) whatever the distribution; the values must be
/// independent. NaN where all values are equal: resampling says nothing then. Source: Efron,
/// J. Amer. Statist. Assoc. 82 (1987) 171; Efron and Tibshirani, An Introduction to the Bootstrap (1993),
/// section 14.3.
/// @throws Failure (bad_input) for a confidence outside (0, 1).
ConfidenceInterval bca_mean(const WeightedSample& sample, const RandomStream& stream,
                            double confidence = summary_confidence,
                            std::int64_t resamples = bootstrap_resamples);

}  // namespace zerocount
