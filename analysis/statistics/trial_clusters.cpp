#include "analysis/statistics/trial_clusters.hpp"

namespace zerocount::statistics {

void TrialClusters::add_trial(std::int64_t trial, std::vector<double>& observed, std::int64_t size) {
  if (rigs_in_all_ == 0) {
    trials_.add_cluster(std::span<double>(observed), size);
    return;
  }
  const auto number = static_cast<std::size_t>(trial % rigs_in_all_);
  if (number >= rigs_.size()) rigs_.resize(number + 1);
  Rig& rig = rigs_[number];
  for (const double value : observed) rig.observed.add(value);
  rig.size += size;
}

ClusteredSample TrialClusters::sample() const {
  if (rigs_in_all_ == 0) return trials_;
  ClusteredSample sample;
  for (const Rig& rig : rigs_) sample.add_cluster(rig.observed, rig.size);
  return sample;
}

}  // namespace zerocount::statistics
