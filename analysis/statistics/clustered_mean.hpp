#pragma once

#include <cstdint>
#include <vector>

#include "analysis/statistics/proportion.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount {

/// Clusters beyond so many are gathered into groups, which are clusters too: more of them would make the
/// bootstrap slower and its bounds no better.
inline constexpr std::int64_t max_clusters = 4096;

inline constexpr std::int64_t bootstrap_resamples = 2000;

/// Sums of values by cluster, and how many values they are of: for a mean Σ sums/Σ numbers.
struct ClusterTotals {
  std::vector<double> sums;     ///< [cluster], in the values' unit
  std::vector<double> numbers;  ///< [cluster]
  std::int64_t clusters{0};     ///< before they were gathered into groups

  /// Adds to cluster number `cluster`, which is kept as number `cluster` mod max_clusters.
  void add(std::int64_t cluster, double sum, double number);
};

/// Σ sums/Σ numbers; NaN of no values.
double mean_of_clusters(const ClusterTotals& totals);

/// Bounds of the mean of values in clusters that are independent, in the values' unit: the outer ones of two
/// intervals. With the mean θ = Σsᵢ/Σnᵢ of m clusters and its standard error by linearisation,
///
///   e² = m/(m − 1)·Σ(sᵢ − θ·nᵢ)²/(Σnᵢ)²,
///
/// Student's is θ ± t(m − 1)·e, and the studentised bootstrap's θ − q·e, q the quantiles of (θ* − θ)/e* over
/// samples of m clusters drawn with replacement.
///
/// Student's interval alone lies too low where long times are rare and the bootstrap's alone falls short of
/// its level with heavy tails; the outer bounds cover with the level where the rare values were seen at all.
/// NaN where nothing is known: fewer than two clusters with values, no spread, or so few clusters that differ
/// that resamples often have none. Sources: Efron and Tibshirani, An Introduction to the Bootstrap (1993),
/// section 12.5; Davison and Hinkley, Bootstrap Methods and their Application (1997), sections 2.4 and 5.2;
/// Field and Welsh, J. R. Statist. Soc. B 69 (2007) 369 (clusters).
/// @throws Failure (bad_input) for a confidence outside (0, 1).
ConfidenceInterval clustered_mean_bounds(const ClusterTotals& totals, const RandomStream& stream,
                                         double confidence = summary_confidence,
                                         std::int64_t resamples = bootstrap_resamples);

/// Bounds of the mean of a number that is counted in clusters, such as the jerks of a trial: sums are the
/// counts, numbers the trials. With fewer than min_counting_clusters clusters in which it was counted at all,
/// the bounds of Garwood for k/φ events scaled by φ, k = Σsᵢ, φ the variance of the mean over that of a
/// Poisson number, never below 1 and t-adjusted as adjusted_events() is; otherwise clustered_mean_bounds().
///
/// Where nothing was counted, the upper bound is Garwood's −ln(tail) per cluster, as if all trials of a
/// cluster were alike: 3.7/m at 95 % for m clusters.
inline constexpr std::int64_t min_counting_clusters = 20;
ConfidenceInterval clustered_count_bounds(const ClusterTotals& totals, const RandomStream& stream,
                                          double confidence = summary_confidence,
                                          std::int64_t resamples = bootstrap_resamples);

}  // namespace zerocount
