#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "analysis/basis/statistics/sums/exact_sum.hpp"
#include "analysis/basis/statistics/unknown.hpp"

namespace zerocount::statistics {

/// Mean, spread and extremes of the finite values of a sample, in the values' unit; NaN without values.
/// Constant memory (Welford 1962).
struct Moments {
  std::int64_t n{0};          ///< Number of finite values.
  std::int64_t nonfinite{0};  ///< Number of values left out because they are infinite or NaN.
  double mean{unknown};
  double min{unknown};
  double max{unknown};
  double squares{0.0};  ///< Sum of the squared deviations from the mean, in the square of the unit.

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

  /// Root mean square of the values; NaN without values.
  double rms() const { return std::sqrt(mean * mean + squares / static_cast<double>(n)); }

  /// Standard deviation with divisor n − 1; NaN of fewer than two values.
  double sd() const { return n < 2 ? unknown : std::sqrt(squares / static_cast<double>(n - 1)); }
};

/// Sums of a sample from which Moments are computed. They are exact: sums of parts of a sample, added in any
/// order, equal the sums of the whole sample.
struct MomentSums {
  std::int64_t n{0};          ///< Number of finite values.
  std::int64_t nonfinite{0};  ///< Number of values left out because they are infinite or NaN.
  double min{unknown};
  double max{unknown};
  ExactSum sum;
  ExactSum squares;  ///< Sum of the squared values, in the square of the unit.

  void add(double value) {
    if (!std::isfinite(value)) {
      ++nonfinite;
      return;
    }
    ++n;
    sum.add(value);
    squares.add_square(value);
    if (!(min <= value)) min = value;  // also where it is NaN, before the first value
    if (!(max >= value)) max = value;
  }

  MomentSums& operator+=(const MomentSums& other) {
    n += other.n;
    nonfinite += other.nonfinite;
    sum += other.sum;
    squares += other.squares;
    min = std::fmin(min, other.min);
    max = std::fmax(max, other.max);
    return *this;
  }

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.n, self.nonfinite, self.min, self.max, self.sum, self.squares);
  }

  Moments moments() const {
    if (n == 0) return {.nonfinite = nonfinite};
    return {n,   nonfinite, sum.value() / static_cast<double>(n),
            min, max,       squared_deviations(sum, squares, n)};
  }
};

}  // namespace zerocount::statistics
