#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

namespace zerocount::statistics {

/// Sets `known` to the values that are not NaN, in their order.
inline void find_known(std::span<const double> values, std::vector<double>& known) {
  known.clear();
  std::ranges::copy_if(values, std::back_inserter(known), [](double value) { return !std::isnan(value); });
}

/// At most `max_count` evenly spaced indices of 0 … `size` − 1, increasing.
inline std::vector<std::int64_t> spread_over(std::int64_t size, std::int64_t max_count) {
  const std::int64_t count = std::min(size, max_count);
  std::vector<std::int64_t> indices;
  for (std::int64_t i = 0; i < count; ++i) indices.push_back(count == 1 ? 0 : i * (size - 1) / (count - 1));
  return indices;
}

/// The value of a statistic that is not known or not defined: NaN.
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace zerocount::statistics
