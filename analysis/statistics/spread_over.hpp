#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace zerocount::statistics {

/// At most `max_count` evenly spaced indices of 0 … `size` − 1, increasing.
inline std::vector<std::int64_t> spread_over(std::int64_t size, std::int64_t max_count) {
  const std::int64_t count = std::min(size, max_count);
  std::vector<std::int64_t> indices;
  for (std::int64_t i = 0; i < count; ++i) indices.push_back(count == 1 ? 0 : i * (size - 1) / (count - 1));
  return indices;
}

}  // namespace zerocount::statistics
