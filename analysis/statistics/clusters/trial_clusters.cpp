#include "analysis/statistics/clusters/trial_clusters.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace zerocount::statistics {

void TrialClusters::add_trial(std::int64_t trial, std::vector<double>& observed, std::int64_t size) {
  if (rigs_in_all_ == 0) {
    trials_.add_cluster(std::span<double>(observed), size);
    return;
  }
  const std::int64_t rig = trial % rigs_in_all_;
  for (const double value : observed) add({rig, value, 1});
  add_size(rig, size);
}

TrialClusters& TrialClusters::operator+=(const TrialClusters& other) {
  trials_ += other.trials_;
  for (const Count& count : other.counts_) add(count);
  for (std::int64_t i = 0; i < std::ssize(other.sizes_); ++i)
    add_size(other.first_ + i, other.sizes_[static_cast<std::size_t>(i)]);
  return *this;
}

void TrialClusters::add(const Count& count) {
  constexpr std::size_t fewest = 64;
  // As many new counts as combined ones: each is sorted a few times at most.
  if (counts_.size() - combined_ >= std::max(fewest, combined_)) combine();
  counts_.push_back(count);
}

void TrialClusters::add_size(std::int64_t rig, std::int64_t size) {
  if (sizes_.empty()) first_ = rig;
  if (rig < first_) {
    sizes_.insert(sizes_.begin(), static_cast<std::size_t>(first_ - rig), 0);
    first_ = rig;
  }
  const auto at = static_cast<std::size_t>(rig - first_);
  if (at >= sizes_.size()) sizes_.resize(at + 1);
  sizes_[at] += size;
}

void TrialClusters::combine() {
  const auto is_before = [](const Count& a, const Count& b) { return a.is_before(b); };
  const auto added = counts_.begin() + static_cast<std::ptrdiff_t>(combined_);
  std::sort(added, counts_.end(), is_before);
  std::inplace_merge(counts_.begin(), added, counts_.end(), is_before);
  auto last = counts_.begin();
  for (auto next = counts_.begin(); next != counts_.end(); ++next) {
    if (next == last) continue;
    if (next->is_of_the_same(*last)) {
      last->times += next->times;
    } else {
      *++last = *next;
    }
  }
  if (!counts_.empty()) counts_.erase(last + 1, counts_.end());
  combined_ = counts_.size();
}

std::int64_t TrialClusters::size() const {
  return std::accumulate(sizes_.begin(), sizes_.end(), trials_.size());
}

ClusteredSample TrialClusters::sample() const {
  if (rigs_in_all_ == 0) return trials_;
  TrialClusters combined = *this;
  combined.combine();
  ClusteredSample sample;
  auto count = combined.counts_.cbegin();
  for (std::int64_t i = 0; i < std::ssize(sizes_); ++i) {
    Histogram<double> observed;
    for (; count != combined.counts_.cend() && count->rig == first_ + i; ++count)
      observed.add(count->value, count->times);
    sample.add_cluster(observed, sizes_[static_cast<std::size_t>(i)]);
  }
  return sample;
}

}  // namespace zerocount::statistics
