#include "analysis/statistics/trial_clusters.hpp"

namespace zerocount {

void TrialClusters::add_trial(std::int64_t trial, std::vector<double>& observed, std::int64_t size) {
  if (rigs_.empty()) {
    trials_.add_cluster(std::span<double>(observed), size);
    return;
  }
  Rig& rig = rigs_[static_cast<std::size_t>(trial) % rigs_.size()];
  for (const double value : observed) rig.observed.add(value);
  rig.size += size;
}

ClusteredSample TrialClusters::sample() const {
  if (rigs_.empty()) return trials_;
  ClusteredSample sample;
  for (const Rig& rig : rigs_) sample.add_cluster(rig.observed, rig.size);
  return sample;
}

}  // namespace zerocount
