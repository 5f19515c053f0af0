#pragma once

#include <cstdint>
#include <iterator>
#include <span>
#include <type_traits>
#include <vector>

#include "analysis/basis/statistics/clusters/by_cluster.hpp"
#include "analysis/basis/statistics/clusters/clustered_quantile.hpp"

namespace zerocount::statistics {

/// Collects the values of trials into clusters. A cluster is a trial, or with machines all trials of a
/// machine; trial i runs on machine i mod machines.
///
/// Memory grows with the number of distinct values of each machine: 24 bytes each.
class TrialClusters {
 public:
  /// @param machines number of machines; 0: every trial is a cluster
  explicit TrialClusters(std::int64_t machines = 0) : machines_in_all_(machines) {}

  /// Adds a trial with `size` values: those in `observed`; the others are censored (larger than all observed
  /// ones).
  /// @param trial index of the trial
  /// @param observed observed values in any order; the call may sort them
  void add_trial(std::int64_t trial, std::vector<double>& observed, std::int64_t size);
  /// Adds consecutive trials with `of_trial` values each.
  /// @param trial index of the first trial
  /// @param values [trial, value] NaN means no value or, if `nan_is_late`, a censored value (larger than all
  /// observed ones)
  void add_trials(std::int64_t trial, std::span<const double> values, std::size_t of_trial, bool nan_is_late);
  /// Adds the trials of another collection with the same number of machines.
  TrialClusters& operator+=(const TrialClusters& other);

  /// All values added so far, with the cluster of each.
  ClusteredSample sample() const;
  std::int64_t size() const;  ///< Number of all values, including the censored ones.

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
  /// Number of times that a certain value occurs on a certain machine.
  struct Count {
    std::int64_t machine{0};
    double value{0.0};
    std::int64_t times{0};

    bool is_before(const Count& other) const {
      return machine < other.machine || (machine == other.machine && value < other.value);
    }
    bool is_of_the_same(const Count& other) const { return machine == other.machine && value == other.value; }
  };

  void add(const Count& count);
  /// Sorts the counts by machine and value, and merges counts of the same machine and value.
  void combine();

  /// Writes for each machine from 0 on: the number of distinct values, each value with its count, the sum of
  /// the counts, and the number of all values.
  template <class Archive>
  void write(Archive& archive) const {
    TrialClusters combined = *this;
    combined.combine();
    archive(sizes_.end());
    auto begin = combined.counts_.cbegin();
    for (std::int64_t machine = 0; machine < sizes_.end(); ++machine) {
      auto end = begin;
      std::int64_t values = 0;
      for (; end != combined.counts_.cend() && end->machine == machine; ++end) values += end->times;
      archive(static_cast<std::int64_t>(end - begin));
      for (; begin != end; ++begin) archive(begin->value, begin->times);
      archive(values, sizes_[machine]);
    }
  }

  template <class Archive>
  void read(Archive& archive) {
    *this = TrialClusters(machines_in_all_);
    std::int64_t machines = 0;
    archive(machines);
    archive.require(machines >= 0 && machines <= machines_in_all_ && machines <= std::ssize(archive.whole()));
    for (std::int64_t machine = 0; machine < machines; ++machine) {
      Histogram<double> observed;
      std::int64_t size = 0;
      archive(observed, size);
      archive.require(observed.size <= size && size <= (std::int64_t{1} << 53) / machines);
      for (const auto& [value, times] : observed.counts) counts_.push_back({machine, value, times});
      sizes_.add(machine, size);
    }
    combined_ = counts_.size();
  }

  std::int64_t machines_in_all_;
  /// Numbers of occurrences of values on machines. The first `combined_` of them are sorted and merged.
  std::vector<Count> counts_;
  std::size_t combined_{0};  ///< Number of elements at the beginning of `counts_` that are sorted and merged.
  ByCluster<> sizes_;        ///< [machine] Number of values, including the censored ones.
  ClusteredSample trials_;   ///< The clusters if there are no machines, so that every trial is a cluster.
};

}  // namespace zerocount::statistics
