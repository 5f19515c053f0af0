#pragma once

#include <cstdint>
#include <vector>

#include "analysis/statistics/clustered_quantile.hpp"

namespace zerocount {

/// Gathers the values of trials into clusters: those of a trial, or with rigs those of all trials of a rig,
/// trial i being on rig i mod rigs.
class TrialClusters {
 public:
  /// @param rigs 0: no trials share a rig
  explicit TrialClusters(std::int64_t rigs = 0) : rigs_in_all_(rigs) {}

  /// Adds a trial with `size` values, of which those in `observed` are known and the rest larger than all
  /// others.
  /// @param observed in any order; sorted by the call
  void add_trial(std::int64_t trial, std::vector<double>& observed, std::int64_t size);

  /// What was added so far.
  ClusteredSample sample() const;

 private:
  struct Rig {
    Histogram<double> observed;
    std::int64_t size{0};
  };
  std::int64_t rigs_in_all_;
  std::vector<Rig> rigs_;   ///< those that have trials
  ClusteredSample trials_;  ///< without rigs
};

}  // namespace zerocount
