#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <type_traits>
#include <vector>

namespace zerocount::statistics {

/// A sum for each rig, zero at first, that parts of a study add up. In memory from the first rig that was
/// added to up to the last one: a block of trials runs on few of many rigs.
template <class Sum = std::int64_t>
class ByRig {
 public:
  void add(std::int64_t rig, const Sum& summand) {
    hold(rig, rig + 1);
    sums_[at(rig)] += summand;
  }

  ByRig& operator+=(const ByRig& other) {
    if (other.sums_.empty()) return *this;
    hold(other.first_, other.end());
    for (std::int64_t rig = other.first_; rig < other.end(); ++rig) sums_[at(rig)] += other[rig];
    return *this;
  }

  Sum operator[](std::int64_t rig) const { return rig < first_ || rig >= end() ? Sum{} : sums_[at(rig)]; }
  /// The rig after the last one that was added to; 0 without any.
  std::int64_t end() const { return first_ + std::ssize(sums_); }
  std::int64_t first() const { return first_; }
  /// Of the rigs from first() on.
  const std::vector<Sum>& sums() const { return sums_; }
  /// Of the rigs from 0 on.
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
  std::size_t at(std::int64_t rig) const { return static_cast<std::size_t>(rig - first_); }

  void hold(std::int64_t first, std::int64_t end_of_rigs) {
    if (sums_.empty()) first_ = first;
    if (first < first_) {
      sums_.insert(sums_.begin(), static_cast<std::size_t>(first_ - first), Sum{});
      first_ = first;
    }
    if (end_of_rigs > end()) sums_.resize(at(end_of_rigs));
  }

  std::int64_t first_{0};
  std::vector<Sum> sums_;  ///< [rig − first_]
};

}  // namespace zerocount::statistics
