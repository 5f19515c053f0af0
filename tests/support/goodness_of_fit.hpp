#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/complement.hpp>

namespace zerocount::testing {

/// p-value of the Kolmogorov–Smirnov test that `values` are uniform on (0, 1), for many values.
inline double kolmogorov_probability(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double step = static_cast<double>(i);
    distance = std::max({distance, values[i] - step / n, (step + 1.0) / n - values[i]});
  }
  double probability = 0.0;
  for (int j = 1; j <= 100; ++j) {
    const double term = 2.0 * std::exp(-2.0 * j * j * n * distance * distance);
    probability += j % 2 == 1 ? term : -term;
  }
  return std::clamp(probability, 0.0, 1.0);
}

/// p-value of the chi-square test that `observed` counts come from `expected`. Neighbouring cells are joined
/// until each expects at least 10.
inline double chi_square_probability(const std::vector<double>& observed,
                                     const std::vector<double>& expected) {
  double statistic = 0.0;
  int cells = 0;
  double seen = 0.0;
  double wanted = 0.0;
  double remaining = 0.0;
  for (const double cell : expected) remaining += cell;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    seen += observed[i];
    wanted += expected[i];
    remaining -= expected[i];
    const bool last = i + 1 == expected.size();
    if (!last && (wanted < 10.0 || remaining < 10.0)) continue;
    statistic += (seen - wanted) * (seen - wanted) / wanted;
    ++cells;
    seen = wanted = 0.0;
  }
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(cells - 1), statistic));
}

}  // namespace zerocount::testing
