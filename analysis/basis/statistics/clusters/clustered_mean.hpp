#pragma once

#include <cstdint>
#include <span>

#include "analysis/basis/statistics/clusters/by_cluster.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/sums/exact_sum.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::statistics {

/// Largest number of clusters that are kept apart. More clusters are merged into this many groups, which are
/// independent clusters again. More groups would slow the bootstrap without improving the bounds.
inline constexpr std::int64_t max_clusters = 4096;

inline constexpr std::int64_t bootstrap_resamples = 2000;

/// Largest number m of clusters for which all resamples are enumerated. The number of different resamples,
/// C(2m − 1, m) = 1716 for m = 7, is then smaller than bootstrap_resamples.
inline constexpr std::int64_t max_enumerated_clusters = 7;

/// Sum and number of the values of each cluster. The mean is Σ sums/Σ numbers. Totals of parts of a sample,
/// added in any order, equal the totals of the whole sample.
struct ClusterTotals {
  ByCluster<ExactSum> sums;  ///< [cluster] Sum of the values, in the values' unit.
  ByCluster<> numbers;       ///< [cluster] Number of values.
  /// [cluster] Number of calls of add(), including calls without values.
  ByCluster<> added;
  /// Highest index passed to add(), before the reduction mod max_clusters; −1 without clusters.
  std::int64_t highest{-1};

  /// Adds values to a cluster, which belongs to group `cluster` mod max_clusters. A cluster to which no
  /// values were ever added does not count as a cluster.
  void add(std::int64_t cluster, std::span<const double> values);
  ClusterTotals& operator+=(const ClusterTotals& other);
  /// Number of clusters before they were merged into groups. It is correct if each cluster was added to once,
  /// or if no cluster below the highest is missing.
  std::int64_t clusters() const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.sums, self.numbers, self.added, self.highest);
  }
};

/// Bounds of the mean of values in independent clusters, in the values' unit: the outer bounds of two
/// intervals. With the mean θ = Σsᵢ/Σnᵢ of m clusters and its standard error by linearisation,
///
///   e² = m/(m − 1)·Σ(sᵢ − θ·nᵢ)²/(Σnᵢ)²,
///
/// Student's is θ ± t(m − 1)·e, and the studentised bootstrap's θ − q·e, q the quantiles of (θ* − θ)/e* over
/// samples of m clusters drawn with replacement: `resamples` of them, or all with their probabilities where
/// m is at most max_enumerated_clusters.
///
/// Student's interval alone lies too low if long times are rare. The bootstrap's alone covers too rarely with
/// heavy tails. The outer bounds have the stated coverage if the sample contains some of the rare values. NaN
/// for fewer than two clusters with values, for no spread, and if so few clusters differ that many resamples
/// have no spread. Sources: Efron and Tibshirani, An Introduction to the Bootstrap (1993), section 12.5;
/// Davison and Hinkley, Bootstrap Methods and their Application (1997), sections 2.4 and 5.2; Field and
/// Welsh, J. R. Statist. Soc. B 69 (2007) 369 (clusters).
/// @throws Failure (bad_input) for a confidence outside (0, 1).
ConfidenceInterval clustered_mean_bounds(const ClusterTotals& totals, const random::RandomStream& stream,
                                         double confidence = summary_confidence,
                                         std::int64_t resamples = bootstrap_resamples);

/// Smallest number of clusters with a count above 0 at which clustered_count_bounds() uses
/// clustered_mean_bounds(). The function gives bounds of the mean of a count in clusters, such as the jerks
/// of a trial: sums are the counts, numbers the trials. With fewer such clusters they are Garwood's bounds
/// for k/φ events, scaled by φ, where k = Σsᵢ and φ ≥ 1 is the variance of the mean divided by that of a
/// Poisson number, t-adjusted like adjusted_events(). If all counts are 0, the upper bound is Garwood's
/// −ln(tail) per cluster, as if all trials of a cluster were equal: 3.7/m at 95 % for m clusters.
inline constexpr std::int64_t min_counting_clusters = 20;
ConfidenceInterval clustered_count_bounds(const ClusterTotals& totals, const random::RandomStream& stream,
                                          double confidence = summary_confidence,
                                          std::int64_t resamples = bootstrap_resamples);

}  // namespace zerocount::statistics
