#include "core/theory/sliding_loop.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace zerocount::theory {

GainCrossover gain_crossover(const FrozenLoop& loop) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto passes = [&](double angle) { return std::abs(open_loop(loop, angle)) >= 1.0; };
  // Downwards from half the sample rate, to a millionth of it.
  constexpr double step = 0.99;
  constexpr double lowest = 1e-6 * std::numbers::pi;
  double high = std::numbers::pi;
  if (passes(high)) return {none, none};
  double low = high * step;
  for (; !passes(low); low *= step) {
    if (low < lowest) return {none, none};
    high = low;
  }
  while (high - low > 1e-12 * high) {
    const double middle = 0.5 * (low + high);
    (passes(middle) ? low : high) = middle;
  }
  const std::complex<double> at = open_loop(loop, low);
  return {low / (2.0 * std::numbers::pi * loop.sample_time), std::arg(-at) * 180.0 / std::numbers::pi};
}

}  // namespace zerocount::theory
