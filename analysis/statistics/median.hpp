#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace zerocount::statistics {

/// The upper median: the value of rank ⌊n/2⌋ + 1 of n ≥ 1 values.
inline double upper_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace zerocount::statistics
