#pragma once

#include <cstddef>

#include "core/numerics/number.hpp"

/// Recurrences for the Taylor coefficients of functions of power series, as templates for double and for the
/// vectors of the batch engine.
namespace zerocount::numerics {

/// Table of reciprocals 1/k of the orders of a series, k ≥ 1, because divisions would take much of the time
/// of a step.
inline constexpr struct Reciprocals {
  double of[24]{};
  constexpr Reciprocals() {
    for (int k = 1; k < 24; ++k) of[k] = 1.0 / k;
  }
  constexpr double operator[](std::size_t k) const { return of[k]; }
} reciprocal;

/// Table of the orders k of a series as floating-point numbers: loading one is faster than converting an
/// integer.
inline constexpr struct Whole {
  double of[24]{};
  constexpr Whole() {
    for (int k = 1; k < 24; ++k) of[k] = k;
  }
} whole;

/// Coefficient k ≥ 1 of the power series of exp(a), by the recurrence of e′ = a′·e.
/// @param derivative coefficients of a′ up to k − 1.
/// @param e coefficients of exp(a) up to k − 1.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number exponential_coefficient(const Number* derivative, const Number* e,
                                                       std::size_t k) {
  Number sum(0.0);
  for (std::size_t j = 0; j < k; ++j) sum = sum + derivative[j] * e[k - 1 - j];
  return sum * Number(reciprocal.of[k]);
}

/// Coefficient k of the product of two power series, a·b.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number product_coefficient(const Number* a, const Number* b, std::size_t k) {
  Number sum = a[0] * b[k];
  for (std::size_t j = 1; j <= k; ++j) sum = sum + a[j] * b[k - j];
  return sum;
}

/// Coefficient k of the quotient q = a/b of two power series, b[0] ≠ 0, by the recurrence of q·b = a.
/// @param a_k coefficient k of a.
/// @param b coefficients up to k.
/// @param q coefficients up to k − 1.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number quotient_coefficient(const Number& a_k, const Number* b, const Number* q,
                                                    std::size_t k) {
  Number rest = a_k;
  for (std::size_t j = 1; j <= k; ++j) rest = rest - b[j] * q[k - j];
  return rest / b[0];
}

/// Coefficient k of the square a² of a power series. Each product a[j]·a[k−j] counts twice, except the middle
/// one.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number square_coefficient(const Number* a, std::size_t k) {
  Number sum(0.0);
  for (std::size_t j = 0; 2 * j < k; ++j) sum = sum + a[j] * a[k - j];
  return Number(2.0) * sum + (k % 2 == 0 ? a[k / 2] * a[k / 2] : Number(0.0));
}

/// Coefficient k ≥ 1 of the power p = aⁿ of a power series, a[0] ≠ 0, any real n, by the recurrence of a·p′ =
/// n·a′·p (Knuth, The Art of Computer Programming, vol. 2, section 4.7), given a[0…k] and p[0…k−1].
/// @param per_start 1/a[0]
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number power_coefficient(const Number* a, const Number* p, const Number& n,
                                                 const Number& per_start, std::size_t k) {
  Number sum(0.0);
  Number weighted(0.0);  // Σ j·a[j]·p[k−j]
  for (std::size_t j = 1; j <= k; ++j) {
    const Number product = a[j] * p[k - j];
    sum = sum + product;
    weighted = weighted + Number(whole.of[j]) * product;
  }
  return ((n + Number(1.0)) * Number(reciprocal.of[k]) * weighted - sum) * per_start;
}

}  // namespace zerocount::numerics
