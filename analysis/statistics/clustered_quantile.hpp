#pragma once

#include <cstdint>
#include <map>
#include <span>

#include "analysis/statistics/clustered_proportion.hpp"
#include "analysis/statistics/histogram.hpp"
#include "analysis/statistics/quantile.hpp"

namespace zerocount {

/// Values in independent clusters, such as the settling times of the moves of a trial. A value may be missing
/// because it is larger than any that could be observed, such as the settling time of a move that never
/// arrived: it counts as larger than all others, and a quantile that falls among such values is NaN.
///
/// Its memory grows with the number of distinct values, not of clusters.
class ClusteredSample {
 public:
  /// Adds a cluster of `size` values, of which those in `observed` are known and the rest larger than all.
  void add_cluster(const Histogram<double>& observed, std::int64_t size);
  /// @param observed in any order; they are sorted
  void add_cluster(std::span<double> observed, std::int64_t size);

  /// The values that are known.
  const Histogram<double>& observed() const { return observed_; }
  /// All values, with those that are larger than all others.
  std::int64_t size() const { return totals_.events; }

  /// Hits and events of the clusters, where a hit is a value ≤ x.
  ClusterSums at_most(double x) const;

 private:
  /// What the clusters' kᵢ(x), their numbers of values ≤ x, change by at a value x.
  struct Step {
    double hits_squared{0.0};    ///< of Σ kᵢ(x)²
    double hits_by_events{0.0};  ///< of Σ kᵢ(x)·nᵢ
  };
  void begin_cluster(std::int64_t size);
  void add_step(double value, std::int64_t before, std::int64_t count, std::int64_t size);

  bool single_values_{true};  ///< every cluster so far has one value: its steps are those of the histogram
  Histogram<double> observed_;
  std::map<double, Step> steps_;
  ClusterSums totals_;
};

/// The sample quantile (the smallest value x such that a proportion of at least `probability` of all values
/// is ≤ x) with order-statistic bounds: the ranks are those of adjusted_events() independent values, scaled
/// to the number of values, the clusters being judged by whether their values are ≤ the sample quantile.
///
/// value, low and high are NaN where they fall among the values that are larger than all others, or where
/// there are too few values for a bound. Sources: Woodruff, J. Amer. Statist. Assoc. 47 (1952) 635; David and
/// Nagaraja, Order Statistics, section 7.1.
/// @throws Failure (bad_input) for a probability or confidence outside (0, 1).
Quantile clustered_quantile(const ClusteredSample& sample, double probability,
                            double confidence = summary_confidence);

/// The smallest value of which can be said, with the stated confidence, that at least the proportion
/// `content` of all values is not above it (Wilks); NaN where there is none. For single values the
/// observation of rank tolerance_rank().
double clustered_upper_limit(const ClusteredSample& sample, double content, double confidence);

}  // namespace zerocount
