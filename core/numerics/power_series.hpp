#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/series_recurrences.hpp"

namespace zerocount::numerics {

/// Order of the Taylor expansions of the motion. With twelve, a sample of the paper's machine (0.62 rad of
/// its fastest oscillation) needs one or two steps at 1e-10 count.
inline constexpr std::size_t series_order = 12;

/// Taylor coefficients of a function of time: Σ_k c[k]·tᵏ.
using Series = std::array<double, series_order + 1>;

/// Value at t of the polynomial with these coefficients, the lowest order first.
inline double value_at(std::span<const double> coefficients, double t) {
  double value = 0.0;
  for (std::size_t k = coefficients.size(); k-- > 0;) value = value * t + coefficients[k];
  return value;
}

/// Upper bound of the absolute change of a polynomial, |Σ_{k≥1} c[k]·tᵏ|, over [0, t], t ≥ 0.
inline double excursion_bound(std::span<const double> coefficients, double t) {
  double bound = 0.0;
  for (std::size_t k = coefficients.size(); k-- > 1;) bound = (bound + std::abs(coefficients[k])) * t;
  return bound;
}

/// Upper bound of the growth of a polynomial, Σ_{k≥1} c[k]·tᵏ, over [0, t], t ≥ 0.
inline double growth_bound(std::span<const double> coefficients, double t) {
  double bound = 0.0;
  for (std::size_t k = coefficients.size(); k-- > 1;) bound = (bound + std::max(coefficients[k], 0.0)) * t;
  return bound;
}

// Divided differences of the exponential function at points that are not positive: the terms of the response
// of a linear first-order system to exponential inputs. Accurate also where the points are close to one
// another or to 0.

/// Divided difference of the exponential function, exp[0, −x] = (1 − e^(−x))/x, x ≥ 0; 1 at x = 0.
inline double exponential_difference(double x) {
  return x == 0.0 ? 1.0 : -expm1(-x) / x;
}

/// Divided difference of the exponential function, exp[−x, −y] = (e^(−x) − e^(−y))/(y − x), x, y ≥ 0; e^(−x)
/// at x = y.
inline double exponential_difference(double x, double y) {
  return exp(-std::min(x, y)) * exponential_difference(std::abs(x - y));
}

/// Second divided difference of the exponential function, exp[0, −x, −y] = (exp[0, −x] − exp[0, −y])/(y − x),
/// x, y ≥ 0; ½ at x = y = 0.
inline double second_exponential_difference(double x, double y) {
  const auto [low, high] = std::minmax(x, y);
  constexpr double series_below = 0.5;
  if (high >= series_below) {
    return (exponential_difference(low) - exponential_difference(low, high)) / high;
  }
  // Σ (−1)^k·h_k/(k + 2)!, with h_k = Σ low^i·high^(k−i) the complete homogeneous symmetric polynomials.
  constexpr int terms = 15;
  double sum = 0.0;
  double polynomial = 1.0;
  double power = 1.0;      // low^k
  double factorial = 2.0;  // (k + 2)!
  for (int k = 0; k < terms; ++k) {
    sum += (k % 2 == 0 ? polynomial : -polynomial) / factorial;
    power *= low;
    polynomial = high * polynomial + power;
    factorial *= static_cast<double>(k + 3);
  }
  return sum;
}

}  // namespace zerocount::numerics
