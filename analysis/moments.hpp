#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace zerocount {

/// Mean and extremes of the finite values of a sample, in the values' unit; NaN where there are none.
/// Constant memory.
struct Moments {
  std::int64_t n{0};          ///< finite values
  std::int64_t nonfinite{0};  ///< values left out because they are not finite
  double mean{std::numeric_limits<double>::quiet_NaN()};
  double min{std::numeric_limits<double>::quiet_NaN()};
  double max{std::numeric_limits<double>::quiet_NaN()};

  void add(double value) {
    if (!std::isfinite(value)) {
      ++nonfinite;
      return;
    }
    ++n;
    mean = n == 1 ? value : mean + (value - mean) / static_cast<double>(n);
    min = n == 1 ? value : std::min(min, value);
    max = n == 1 ? value : std::max(max, value);
  }
};

}  // namespace zerocount
