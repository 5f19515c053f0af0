#pragma once

#include <cstdint>
#include <vector>

#include "analysis/statistics/clustered_quantile.hpp"

namespace zerocount::statistics {

/// Collects the values of trials into clusters. A cluster is a trial, or with rigs all trials of a rig; trial
/// i runs on rig i mod rigs.
class TrialClusters {
 public:
  /// @param rigs number of rigs; 0: every trial is a cluster
  explicit TrialClusters(std::int64_t rigs = 0) : rigs_in_all_(rigs) {}

  /// Adds a trial with `size` values: those in `observed`; the others are censored (larger than all observed
  /// ones).
  /// @param observed in any order; sorted by the call
  void add_trial(std::int64_t trial, std::vector<double>& observed, std::int64_t size);

  /// The sample of all trials added so far.
  ClusteredSample sample() const;

 private:
  struct Rig {
    Histogram<double> observed;
    std::int64_t size{0};
  };
  std::int64_t rigs_in_all_;
  std::vector<Rig> rigs_;   ///< rigs that have trials
  ClusteredSample trials_;  ///< without rigs
};

}  // namespace zerocount::statistics
