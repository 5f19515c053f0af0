#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

namespace zerocount {

/// A sample kept as value → how often it occurred. Its memory grows with the number of distinct values, not
/// of observations: counts and times that are whole multiples of a sample time have few.
template <typename Value>
struct Tally {
  std::map<Value, std::int64_t> counts;
  std::int64_t size{0};  ///< number of observations

  void add(Value value, std::int64_t times = 1) {
    counts[value] += times;
    size += times;
  }
};

/// Mean, in the values' unit; NaN of an empty tally. Summed in the order of the values: independent of the
/// order they came in.
template <typename Value>
double mean(const Tally<Value>& tally) {
  double sum = 0.0;
  for (const auto& [value, count] : tally.counts)
    sum += static_cast<double>(value) * static_cast<double>(count);
  return tally.size > 0 ? sum / static_cast<double>(tally.size) : std::numeric_limits<double>::quiet_NaN();
}

/// Standard deviation with divisor n − 1, in the values' unit; NaN of fewer than two observations.
template <typename Value>
double standard_deviation(const Tally<Value>& tally) {
  if (tally.size < 2) return std::numeric_limits<double>::quiet_NaN();
  const double centre = mean(tally);
  double squares = 0.0;
  for (const auto& [value, count] : tally.counts) {
    const double deviation = static_cast<double>(value) - centre;
    squares += deviation * deviation * static_cast<double>(count);
  }
  return std::sqrt(squares / static_cast<double>(tally.size - 1));
}

/// Sum, in the values' unit.
template <typename Value>
Value total(const Tally<Value>& tally) {
  Value sum{};
  for (const auto& [value, count] : tally.counts) sum += value * static_cast<Value>(count);
  return sum;
}

/// Smallest and largest value; NaN of an empty tally.
template <typename Value>
double smallest(const Tally<Value>& tally) {
  return tally.size > 0 ? static_cast<double>(tally.counts.begin()->first)
                        : std::numeric_limits<double>::quiet_NaN();
}
template <typename Value>
double largest(const Tally<Value>& tally) {
  return tally.size > 0 ? static_cast<double>(tally.counts.rbegin()->first)
                        : std::numeric_limits<double>::quiet_NaN();
}

/// The `rank`-th smallest observation, rank = 1 … size; NaN outside that.
template <typename Value>
double order_statistic(const Tally<Value>& tally, std::int64_t rank) {
  if (rank >= 1) {
    std::int64_t below = 0;
    for (const auto& [value, count] : tally.counts) {
      below += count;
      if (below >= rank) return static_cast<double>(value);
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace zerocount
