#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <type_traits>
#include <vector>

namespace zerocount::statistics {

/// A sum for each cluster, such as a machine. All sums are zero at first. Sums of parts of a study can be
/// added. Memory is used from the first to the last cluster that was added to, because a block of trials
/// belongs to few of many clusters.
template <class Sum = std::int64_t>
class ByCluster {
 public:
  /// The sum of the cluster with this index, as a reference to add to.
  Sum& sum_of(std::int64_t cluster) {
    hold(cluster, cluster + 1);
    return sums_[at(cluster)];
  }
  void add(std::int64_t cluster, const Sum& summand) { sum_of(cluster) += summand; }

  ByCluster& operator+=(const ByCluster& other) {
    if (other.sums_.empty()) return *this;
    hold(other.first_, other.end());
    for (std::int64_t cluster = other.first_; cluster < other.end(); ++cluster)
      sums_[at(cluster)] += other.sums_[other.at(cluster)];
    return *this;
  }

  Sum operator[](std::int64_t cluster) const {
    return cluster < first_ || cluster >= end() ? Sum{} : sums_[at(cluster)];
  }
  /// One past the highest index of a cluster that was added to; 0 if none was.
  std::int64_t end() const { return first_ + std::ssize(sums_); }
  std::int64_t first() const { return first_; }
  /// [cluster − first()] The sums of the clusters from first() on.
  const std::vector<Sum>& sums() const { return sums_; }
  /// [cluster] The sums of all clusters from index 0 on, zero for those before first().
  std::vector<Sum> from_zero() const {
    std::vector<Sum> sums(static_cast<std::size_t>(first_));
    sums.insert(sums.end(), sums_.begin(), sums_.end());
    return sums;
  }

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    if constexpr (std::is_const_v<Self>) {
      archive(self.from_zero());
    } else {
      archive(self.sums_);
      self.first_ = 0;
    }
  }

 private:
  std::size_t at(std::int64_t cluster) const { return static_cast<std::size_t>(cluster - first_); }

  void hold(std::int64_t first, std::int64_t end_of_clusters) {
    if (sums_.empty()) first_ = first;
    if (first < first_) {
      sums_.insert(sums_.begin(), static_cast<std::size_t>(first_ - first), Sum{});
      first_ = first;
    }
    if (end_of_clusters > end()) sums_.resize(at(end_of_clusters));
  }

  std::int64_t first_{0};
  std::vector<Sum> sums_;  ///< [cluster − first_] Sum of the cluster.
};

}  // namespace zerocount::statistics
