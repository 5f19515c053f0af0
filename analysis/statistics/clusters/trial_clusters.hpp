#pragma once

#include <cstdint>
#include <iterator>
#include <span>
#include <type_traits>
#include <vector>

#include "analysis/statistics/clusters/by_cluster.hpp"
#include "analysis/statistics/clusters/clustered_quantile.hpp"

namespace zerocount::statistics {

/// Collects the values of trials into clusters. A cluster is a trial, or with rigs all trials of a rig; trial
/// i runs on rig i mod rigs.
///
/// Memory grows with the number of distinct values of each rig: 24 bytes each.
class TrialClusters {
 public:
  /// @param rigs number of rigs; 0: every trial is a cluster
  explicit TrialClusters(std::int64_t rigs = 0) : rigs_in_all_(rigs) {}

  /// Adds a trial with `size` values: those in `observed`; the others are censored (larger than all observed
  /// ones).
  /// @param observed in any order; the call may sort them
  void add_trial(std::int64_t trial, std::vector<double>& observed, std::int64_t size);
  /// Adds trials with `of_trial` values each. @param trial index of the first @param values [trial, value];
  /// NaN: none, or if `nan_is_late` one that is censored
  void add_trials(std::int64_t trial, std::span<const double> values, std::size_t of_trial, bool nan_is_late);
  /// Adds other trials, of as many rigs.
  TrialClusters& operator+=(const TrialClusters& other);

  /// The sample of all trials added so far.
  ClusteredSample sample() const;
  std::int64_t size() const;  ///< of the sample

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    if constexpr (std::is_const_v<Self>) {
      self.write(archive);
    } else {
      self.read(archive);
    }
    archive(self.trials_);
  }

 private:
  /// How often a rig has a value.
  struct Count {
    std::int64_t rig{0};
    double value{0.0};
    std::int64_t times{0};

    bool is_before(const Count& other) const {
      return rig < other.rig || (rig == other.rig && value < other.value);
    }
    bool is_of_the_same(const Count& other) const { return rig == other.rig && value == other.value; }
  };

  void add(const Count& count);
  /// Sorts the counts by rig and value, and adds those of the same.
  void combine();

  /// For each rig from 0 on: the number of distinct values, each value with its count, the sum of the counts,
  /// and the number of all values.
  template <class Archive>
  void write(Archive& archive) const {
    TrialClusters combined = *this;
    combined.combine();
    archive(sizes_.end());
    auto begin = combined.counts_.cbegin();
    for (std::int64_t rig = 0; rig < sizes_.end(); ++rig) {
      auto end = begin;
      std::int64_t values = 0;
      for (; end != combined.counts_.cend() && end->rig == rig; ++end) values += end->times;
      archive(static_cast<std::int64_t>(end - begin));
      for (; begin != end; ++begin) archive(begin->value, begin->times);
      archive(values, sizes_[rig]);
    }
  }

  template <class Archive>
  void read(Archive& archive) {
    *this = TrialClusters(rigs_in_all_);
    std::int64_t rigs = 0;
    archive(rigs);
    archive.require(rigs >= 0 && rigs <= rigs_in_all_ && rigs <= std::ssize(archive.whole()));
    for (std::int64_t rig = 0; rig < rigs; ++rig) {
      Histogram<double> observed;
      std::int64_t size = 0;
      archive(observed, size);
      archive.require(observed.size <= size && size <= (std::int64_t{1} << 53) / rigs);
      for (const auto& [value, times] : observed.counts) counts_.push_back({rig, value, times});
      sizes_.add(rig, size);
    }
    combined_ = counts_.size();
  }

  std::int64_t rigs_in_all_;
  std::vector<Count> counts_;  ///< of rigs; the first ones are combined
  std::size_t combined_{0};    ///< how many
  ByCluster<> sizes_;          ///< numbers of values, with the censored ones
  ClusteredSample trials_;     ///< without rigs
};

}  // namespace zerocount::statistics
