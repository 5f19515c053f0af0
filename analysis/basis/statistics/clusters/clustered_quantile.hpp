#pragma once

#include <cstdint>
#include <iterator>
#include <map>
#include <span>
#include <type_traits>
#include <vector>

#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/basis/statistics/sums/histogram.hpp"

namespace zerocount::statistics {

/// Values in independent clusters, such as the settling times of the moves of a trial. Values may be
/// censored: a move that never arrived has a settling time larger than all observed ones. A quantile that
/// falls among censored values is NaN.
///
/// Memory grows with the number of distinct values, not with the number
/// of clusters.
class ClusteredSample {
 public:
  /// Adds a cluster of `size` values: those in `observed`; the others are censored (larger than all observed
  /// ones).
  void add_cluster(const Histogram<double>& observed, std::int64_t size);
  /// Adds a cluster of `size` values.
  /// @param observed its observed values in any order; they are sorted; the other values are censored
  void add_cluster(std::span<double> observed, std::int64_t size);
  /// Adds clusters of one value each: the observed ones, in any order.
  /// @param censored number of further clusters, whose only value is censored
  void add_single_values(std::span<const double> observed, std::int64_t censored);
  /// Adds the clusters of another sample.
  ClusteredSample& operator+=(const ClusteredSample& other);

  /// The values that are not censored.
  const Histogram<double>& observed() const { return observed_; }
  /// Number of all values, including the censored ones.
  std::int64_t size() const { return totals_.events; }

  /// Sums over the clusters of hits and events, where a hit is a value ≤ x and every value is an event.
  ClusterSums at_most(double x) const;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.single_values_, self.observed_, self.steps_, self.totals_);
    if constexpr (!std::is_const_v<Self>) archive.require(self.observed_.size <= self.totals_.events);
  }

 private:
  /// Increments at x of sums over the clusters' numbers kᵢ(x) of values ≤ x.
  struct Step {
    double hits_squared{0.0};    ///< Increment of Σ kᵢ(x)².
    double hits_by_events{0.0};  ///< Increment of Σ kᵢ(x)·nᵢ.

    template <class Self, class Archive>
    static void transfer(Self& self, Archive& archive) {
      archive(self.hits_squared, self.hits_by_events);
    }
  };
  void begin_cluster(std::int64_t size);
  void count_in_steps();
  void add_step(double value, std::int64_t before, std::int64_t count, std::int64_t size);

  /// True while every cluster has a single value. The increments of the sums then follow from the histogram
  /// alone.
  bool single_values_{true};
  Histogram<double> observed_;
  std::map<double, Step> steps_;
  ClusterSums totals_;
};

/// The sample quantile of clustered values (the smallest value x such that a proportion of at least
/// `probability` of all values is ≤ x) with order-statistic bounds. Their ranks are those for
/// adjusted_events() independent values, scaled to the number of values; a hit of a cluster is a value ≤ the
/// sample quantile.
///
/// value, low and high
/// are NaN if they fall among the censored values, or if there are too few values for a bound. Sources:
/// Woodruff, J. Amer. Statist. Assoc. 47 (1952) 635; David and Nagaraja, Order Statistics, section 7.1.
/// @throws Failure (bad_input) for a probability or confidence outside (0, 1).
Quantile clustered_quantile(const ClusteredSample& sample, double probability,
                            double confidence = summary_confidence);

/// Upper tolerance limit (Wilks): with the stated confidence, at least the proportion `content` of all values
/// is not above it. NaN if there are too few values. For clusters of one value it is the observation of rank
/// tolerance_rank().
double clustered_upper_limit(const ClusteredSample& sample, double content, double confidence);

}  // namespace zerocount::statistics
