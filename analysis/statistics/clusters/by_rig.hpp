#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

namespace zerocount::statistics {

/// A number of each rig, zero at first, that parts of a study add up. In memory from the first rig that was
/// added to up to the last one: a block of trials runs on few of many rigs.
class ByRig {
 public:
  void add(std::int64_t rig, std::int64_t number) {
    hold(rig, rig + 1);
    numbers_[at(rig)] += number;
  }

  ByRig& operator+=(const ByRig& other) {
    if (other.numbers_.empty()) return *this;
    hold(other.first_, other.end());
    for (std::int64_t rig = other.first_; rig < other.end(); ++rig) numbers_[at(rig)] += other[rig];
    return *this;
  }

  std::int64_t operator[](std::int64_t rig) const {
    return rig < first_ || rig >= end() ? 0 : numbers_[at(rig)];
  }
  /// The rig after the last one that was added to; 0 without any.
  std::int64_t end() const { return first_ + std::ssize(numbers_); }
  std::int64_t first() const { return first_; }
  /// Of the rigs from first() on.
  const std::vector<std::int64_t>& numbers() const { return numbers_; }

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    std::vector<std::int64_t> from_zero(static_cast<std::size_t>(self.first_));
    from_zero.insert(from_zero.end(), self.numbers_.begin(), self.numbers_.end());
    archive(from_zero);
    if constexpr (!std::is_const_v<Self>) {
      self.first_ = 0;
      self.numbers_ = std::move(from_zero);
    }
  }

 private:
  std::size_t at(std::int64_t rig) const { return static_cast<std::size_t>(rig - first_); }

  void hold(std::int64_t first, std::int64_t end_of_rigs) {
    if (numbers_.empty()) first_ = first;
    if (first < first_) {
      numbers_.insert(numbers_.begin(), static_cast<std::size_t>(first_ - first), 0);
      first_ = first;
    }
    if (end_of_rigs > end()) numbers_.resize(at(end_of_rigs));
  }

  std::int64_t first_{0};
  std::vector<std::int64_t> numbers_;  ///< [rig − first_]
};

}  // namespace zerocount::statistics
