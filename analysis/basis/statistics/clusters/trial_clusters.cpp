#include "analysis/basis/statistics/clusters/trial_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "analysis/basis/statistics/unknown.hpp"

namespace zerocount::statistics {

void TrialClusters::add_trial(std::int64_t trial, std::vector<double>& observed, std::int64_t size) {
  if (machines_in_all_ == 0) {
    trials_.add_cluster(std::span<double>(observed), size);
    return;
  }
  const std::int64_t machine = trial % machines_in_all_;
  for (const double value : observed) add({machine, value, 1});
  sizes_.add(machine, size);
}

void TrialClusters::add_trials(std::int64_t trial, std::span<const double> values, std::size_t of_trial,
                               bool nan_is_late) {
  std::vector<double> observed;
  observed.reserve(values.size());
  const auto observe = [&](std::span<const double> some) {
    find_known(some, observed);
    return nan_is_late ? std::ssize(some) : std::ssize(observed);
  };
  if (machines_in_all_ == 0 && of_trial == 1) {
    const std::int64_t size = observe(values);
    return trials_.add_single_values(observed, size - std::ssize(observed));
  }
  for (; !values.empty(); values = values.subspan(of_trial)) {
    const std::int64_t size = observe(values.first(of_trial));
    add_trial(trial++, observed, size);
  }
}

TrialClusters& TrialClusters::operator+=(const TrialClusters& other) {
  trials_ += other.trials_;
  for (const Count& count : other.counts_) add(count);
  sizes_ += other.sizes_;
  return *this;
}

void TrialClusters::add(const Count& count) {
  constexpr std::size_t fewest = 64;
  // Combining when the new counts are as many as the combined ones sorts each count a few times at most.
  if (counts_.size() - combined_ >= std::max(fewest, combined_)) combine();
  counts_.push_back(count);
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
  return std::accumulate(sizes_.sums().begin(), sizes_.sums().end(), trials_.size());
}

ClusteredSample TrialClusters::sample() const {
  if (machines_in_all_ == 0) return trials_;
  TrialClusters combined = *this;
  combined.combine();
  ClusteredSample sample;
  auto count = combined.counts_.cbegin();
  for (std::int64_t machine = sizes_.first(); machine < sizes_.end(); ++machine) {
    Histogram<double> observed;
    for (; count != combined.counts_.cend() && count->machine == machine; ++count)
      observed.add(count->value, count->times);
    sample.add_cluster(observed, sizes_[machine]);
  }
  return sample;
}

}  // namespace zerocount::statistics
