#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/numerics/series_recurrences.hpp"

namespace zerocount::numerics {

/// Order of the Taylor expansions of the motion. With twelve, a sample of the paper's rig (0.62 rad of its
/// fastest oscillation) needs one or two steps at 1e-10 count.
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

}  // namespace zerocount::numerics
