#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <type_traits>

#include "analysis/basis/statistics/unknown.hpp"

namespace zerocount::statistics {

/// A sample as a map from values to numbers of occurrences. Memory grows with the number of distinct values,
/// which is small for counts and for times that are multiples of a sample time.
template <typename Value>
struct Histogram {
  std::map<Value, std::int64_t> counts;
  std::int64_t size{0};  ///< Number of observations.

  void add(Value value, std::int64_t times = 1) {
    counts[value] += times;
    size += times;
  }

  Histogram& operator+=(const Histogram& other) {
    for (const auto& [value, times] : other.counts) add(value, times);
    return *this;
  }

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.counts, self.size);
    if constexpr (!std::is_const_v<Self>) {
      std::int64_t size = 0;
      for (const auto& [value, times] : self.counts) {
        archive.require(times > 0 && times <= self.size - size);
        size += times;
      }
      archive.require(size == self.size);
    }
  }
};

/// Mean, in the values' unit; NaN of an empty histogram. Summed in the order of the values, so that it does
/// not depend on the order of insertion.
template <typename Value>
double mean(const Histogram<Value>& histogram) {
  double sum = 0.0;
  for (const auto& [value, count] : histogram.counts)
    sum += static_cast<double>(value) * static_cast<double>(count);
  return histogram.size > 0 ? sum / static_cast<double>(histogram.size) : unknown;
}

/// Standard deviation with divisor n − 1, in the values' unit; NaN of fewer than two observations.
template <typename Value>
double standard_deviation(const Histogram<Value>& histogram) {
  if (histogram.size < 2) return unknown;
  const double centre = mean(histogram);
  double squares = 0.0;
  for (const auto& [value, count] : histogram.counts) {
    const double deviation = static_cast<double>(value) - centre;
    squares += deviation * deviation * static_cast<double>(count);
  }
  return std::sqrt(squares / static_cast<double>(histogram.size - 1));
}

/// Sum of all observations, in the values' unit.
template <typename Value>
Value total(const Histogram<Value>& histogram) {
  Value sum{};
  for (const auto& [value, count] : histogram.counts) sum += value * static_cast<Value>(count);
  return sum;
}

/// Smallest and, in the next function, largest observation; NaN for an empty histogram.
template <typename Value>
double smallest(const Histogram<Value>& histogram) {
  return histogram.size > 0 ? static_cast<double>(histogram.counts.begin()->first) : unknown;
}
template <typename Value>
double largest(const Histogram<Value>& histogram) {
  return histogram.size > 0 ? static_cast<double>(histogram.counts.rbegin()->first) : unknown;
}

/// The `rank`-th smallest observation, rank = 1 … size; NaN outside that.
template <typename Value>
double order_statistic(const Histogram<Value>& histogram, std::int64_t rank) {
  if (rank >= 1) {
    std::int64_t below = 0;
    for (const auto& [value, count] : histogram.counts) {
      below += count;
      if (below >= rank) return static_cast<double>(value);
    }
  }
  return unknown;
}

}  // namespace zerocount::statistics
