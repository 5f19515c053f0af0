#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace zerocount {

/// Order of the Taylor expansions of the motion. Twelve takes a whole sample of the paper's rig (0.62 rad of
/// its fastest oscillation) in one or two steps at 1e-10 count.
inline constexpr std::size_t series_order = 12;

/// Taylor coefficients of a function of time: Σ_k c[k]·tᵏ.
using Series = std::array<double, series_order + 1>;

/// The polynomial's value at t.
inline double value_at(std::span<const double> coefficients, double t) {
  double value = 0.0;
  for (std::size_t k = coefficients.size(); k-- > 0;) value = value * t + coefficients[k];
  return value;
}

/// Upper bound of |Σ_{k≥1} c[k]·tᵏ| over [0, t], t ≥ 0.
inline double excursion_bound(std::span<const double> coefficients, double t) {
  double bound = 0.0;
  for (std::size_t k = coefficients.size(); k-- > 1;) bound = (bound + std::abs(coefficients[k])) * t;
  return bound;
}

/// Upper bound of Σ_{k≥1} c[k]·tᵏ over [0, t], t ≥ 0.
inline double growth_bound(std::span<const double> coefficients, double t) {
  double bound = 0.0;
  for (std::size_t k = coefficients.size(); k-- > 1;) bound = (bound + std::max(coefficients[k], 0.0)) * t;
  return bound;
}

/// 1/k for the orders of a series, k ≥ 1: dividing by them would take a good part of the time of a step.
inline constexpr auto reciprocal = [] {
  std::array<double, series_order + 2> table{};
  for (std::size_t k = 1; k < table.size(); ++k) table[k] = 1.0 / static_cast<double>(k);
  return table;
}();

/// Coefficient k ≥ 1 of exp(a): from e′ = a′·e, given the coefficients of the derivative a′[0…k−1] and
/// e[0…k−1].
inline double exponential_coefficient(const Series& derivative, const Series& e, std::size_t k) {
  double sum = 0.0;
  for (std::size_t j = 0; j < k; ++j) sum += derivative[j] * e[k - 1 - j];
  return sum * reciprocal[k];
}

/// Coefficient k of a²: each product a[j]·a[k−j] stands twice, but for the one in the middle.
inline double square_coefficient(const Series& a, std::size_t k) {
  double sum = 0.0;
  for (std::size_t j = 0; 2 * j < k; ++j) sum += a[j] * a[k - j];
  return 2.0 * sum + (k % 2 == 0 ? a[k / 2] * a[k / 2] : 0.0);
}

/// Coefficient k ≥ 1 of aⁿ, a[0] ≠ 0, any real n: from a·p′ = n·a′·p (Knuth, The Art of Computer Programming,
/// vol. 2, section 4.7), given a[0…k] and p[0…k−1].
inline double power_coefficient(const Series& a, const Series& p, double n, std::size_t k) {
  double sum = 0.0;
  for (std::size_t j = 1; j <= k; ++j) {
    const double weight = n * static_cast<double>(j) - static_cast<double>(k - j);
    sum += weight * a[j] * p[k - j];
  }
  return sum * reciprocal[k] / a[0];
}

}  // namespace zerocount
