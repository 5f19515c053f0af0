#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>

namespace zerocount::numerics {

// Searches for the place at which a condition changes.

/// The smallest number from `low` on, below `end`, for which `holds`; `end` if there is none. `holds` must be
/// monotonic: false, then true.
template <class Condition>
std::int64_t first_where(std::int64_t low, std::int64_t end, const Condition& holds) {
  while (low < end) {
    const std::int64_t middle = low + (end - low) / 2;
    if (holds(middle)) {
      end = middle;
    } else {
      low = middle + 1;
    }
  }
  return end;
}

/// Gives the result of first_where() for a result that is probably small. It doubles from `low` on before it
/// bisects, so that `holds` is asked only for numbers up to twice the result.
template <class Condition>
std::int64_t first_where_by_doubling(std::int64_t low, std::int64_t end, const Condition& holds) {
  std::int64_t high = std::min(std::max<std::int64_t>(low, 1), end);
  while (high < end && !holds(high)) {
    low = high + 1;
    high = std::min(2 * high, end);
  }
  return first_where(low, high, holds);
}

inline double arithmetic_mean(double a, double b) {
  return 0.5 * (a + b);
}

inline double geometric_mean(double a, double b) {
  return std::sqrt(a * b);
}

/// Two numbers, in either order, between which a condition changes from true to false.
struct Bracket {
  double holds;  ///< End at which the condition holds
  double fails;  ///< End at which the condition does not hold
};

/// Bisection between a number at which `condition` is true and one at which it is false:
///
///     until narrow(bracket), or its middle equals one of its ends:
///       the middle replaces the end at which `condition` has the same value
///
/// The condition is not evaluated at the given ends.
/// @returns the final bracket.
template <class Condition, class Narrow, class Mean = double(double, double)>
Bracket bisect(Bracket bracket, const Condition& condition, Narrow narrow,
               const Mean& mean = arithmetic_mean) {
  while (!narrow(bracket)) {
    const double middle = mean(bracket.holds, bracket.fails);
    if (middle == bracket.holds || middle == bracket.fails) break;
    (condition(middle) ? bracket.holds : bracket.fails) = middle;
  }
  return bracket;
}

/// Criterion for bisect(): the bracket is narrow enough after `count` halvings.
inline auto after_halvings(int count) {
  return [left = count](const Bracket&) mutable { return left-- == 0; };
}

/// Criterion for bisect(): the bracket is narrow enough if its ends differ by `width` or less.
inline auto within(double width) {
  return [width](const Bracket& bracket) { return std::abs(bracket.holds - bracket.fails) <= width; };
}

/// The first t in (0, end] at which the polynomial Σ_k c[k]·tᵏ changes the sign that it has at t = 0
/// (c[0] ≠ 0); empty if it does not.
///
/// Finds every excursion to the other sign that lasts at least end·2⁻⁴⁰: the polynomial is subdivided in
/// Bernstein form, whose coefficients bound it (Farouki, "The Bernstein polynomial basis: a centennial
/// retrospective", CAGD 29, 2012), until one sign variation of the coefficients isolates one root. At most 16
/// coefficients.
std::optional<double> first_sign_change(std::span<const double> coefficients, double end);

/// The root in [low, high] of a polynomial with opposite signs at the ends, to about the last bit.
double bracketed_root(std::span<const double> coefficients, double low, double high);

/// A local minimum of f between `low` and `high`, (x, f(x)), by Brent's method.
/// @param bits accuracy of x in bits: the method stops at 2^-bits of |x|, and at about 2^-bits absolutely.
std::pair<double, double> minimum_between(double low, double high, int bits,
                                          const std::function<double(double)>& f);

}  // namespace zerocount::numerics
