#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "analysis/statistics/unknown.hpp"

namespace zerocount::statistics {

/// Mean, spread and extremes of the finite values of a sample, in the values' unit; NaN without values.
/// Constant memory (Welford 1962).
struct Moments {
  std::int64_t n{0};          ///< finite values
  std::int64_t nonfinite{0};  ///< values left out because they are not finite
  double mean{unknown};
  double min{unknown};
  double max{unknown};
  double squares{0.0};  ///< sum of the squared deviations from the mean, in the square of the unit

  void add(double value) {
    if (!std::isfinite(value)) {
      ++nonfinite;
      return;
    }
    ++n;
    const double deviation = n == 1 ? 0.0 : value - mean;
    mean = n == 1 ? value : mean + deviation / static_cast<double>(n);
    squares += deviation * (value - mean);
    min = n == 1 ? value : std::min(min, value);
    max = n == 1 ? value : std::max(max, value);
  }

  /// Root of the mean square; NaN of no values.
  double rms() const { return std::sqrt(mean * mean + squares / static_cast<double>(n)); }

  /// Standard deviation with divisor n − 1; NaN of fewer than two values.
  double sd() const { return n < 2 ? unknown : std::sqrt(squares / static_cast<double>(n - 1)); }
};

}  // namespace zerocount::statistics
