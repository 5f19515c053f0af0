#include "core/numerics/elementary_functions.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <sleef.h>

#include "core/numerics/elementary_tables.hpp"
#include "core/numerics/logarithm_by_series.hpp"

namespace zerocount::numerics {
namespace {

/// Largest |x| for which the table-driven exponential has no intermediate value that overflows or is
/// subnormal.
constexpr double max_table_argument = 700.0;

/// Result of the table-driven exponential function, exp(x) = scale·(1 + excess), with scale = 2^(k/128) from
/// the table and |excess| < 0.003 (Tang, ACM Trans. Math. Softw. 15 (1989) 144). The polynomial is the series
/// of exp(r) − 1, |r| ≤ ln 2/256, to r⁵.
struct ScaledExponential {
  double scale;
  double excess;
};

/// Computes exp(x + x_error).
/// @param x_error correction to x, far smaller than x.
ScaledExponential scaled_exponential(double x, double x_error = 0.0) noexcept {
  constexpr double to_whole = 0x1.8p52;  // a number so large that its last bit is 1
  const double shifted = x * steps_per_unit + to_whole;
  const std::int64_t steps = std::bit_cast<std::int64_t>(shifted) - std::bit_cast<std::int64_t>(to_whole);
  const double whole = shifted - to_whole;
  const double r = ((x - whole * step_high) - whole * step_low) + x_error;
  const PowerOfTwo& power = powers_of_two[static_cast<std::size_t>(steps & (table_steps - 1))];
  const auto doublings = static_cast<std::uint64_t>(steps >> 7);
  const double r2 = r * r;
  const double rest = r2 * ((1.0 / 2.0 + r * (1.0 / 6.0)) + r2 * (1.0 / 24.0 + r * (1.0 / 120.0)));
  return {std::bit_cast<double>(std::bit_cast<std::uint64_t>(power.value) + (doublings << 52)),
          power.tail + r + rest};
}

/// The Taylor series of exp(x) − 1 to x⁷, for |x| < 0.02.
double small_expm1(double x) noexcept {
  const double x2 = x * x;
  const double high = (1.0 / 24.0 + x * (1.0 / 120.0)) + x2 * (1.0 / 720.0 + x * (1.0 / 5040.0));
  return x + x2 * ((1.0 / 2.0 + x * (1.0 / 6.0)) + x2 * high);
}

/// A number as the unevaluated sum of two doubles; `high` is the number rounded to a double.
struct Sum {
  double high;
  double low;
};

/// The sum a + b as two doubles, exact if |a| ≥ |b| or a = 0 (Dekker, Numer. Math. 18 (1971) 224).
Sum exact_sum(double a, double b) noexcept {
  const double high = a + b;
  return {high, (a - high) + b};
}

/// Splits a double into its first 26 bits and the other 27 as the sum of two doubles.
Sum halves(double x) noexcept {
  constexpr std::uint64_t upper = ~((std::uint64_t{1} << 27) - 1);
  const double high = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & upper);
  return {high, x - high};
}

bool is_normal_and_positive(double x) noexcept {
  return x >= std::numeric_limits<double>::min() && x <= std::numeric_limits<double>::max();
}

/// Natural logarithm ln x of a normal number x > 0, to 2⁻⁶⁵: x = 2ᵏ·c·(1 + r) with ln c from the table and
/// |r| < 2⁻⁷·⁹ (Tang, ACM Trans. Math. Softw. 16 (1990) 378).
Sum logarithm(double x) noexcept {
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t after_start = bits - logarithm_start;
  const auto doublings = static_cast<std::int64_t>(after_start) >> 52;
  const LogarithmStep& step = logarithms[(after_start >> logarithm_interval_bits) & (logarithm_steps - 1)];
  const Sum z = halves(std::bit_cast<double>(bits - (static_cast<std::uint64_t>(doublings) << 52)));
  // Exact: the products of 26 and of 27 bits with 24 are.
  const double r_high = z.high * step.reciprocal - 1.0;
  const double r_low = z.low * step.reciprocal;
  const double r = r_high + r_low;
  const double r_error = (r_high - r) + r_low;
  const auto k = static_cast<double>(doublings);
  const Sum linear = exact_sum(k * ln2_high + step.high, r);
  // −r²/2, of which the first term is exact.
  const Sum part = halves(r);
  const Sum sum = exact_sum(linear.high, -0.5 * part.high * part.high);
  const double square_rest = -0.5 * part.low * (r + part.high);
  const double r2 = r * r;
  const double series = r * r2 *
                        ((1.0 / 3.0 - r * (1.0 / 4.0)) +
                         r2 * ((1.0 / 5.0 - r * (1.0 / 6.0)) + r2 * (1.0 / 7.0 - r * (1.0 / 8.0))));
  const double low = ((k * ln2_low + step.low) + (r_error - r * r_error)) +
                     ((linear.low + sum.low) + (square_rest + series));
  return exact_sum(sum.high, low);
}

/// Argument x reduced by multiples of π/2: x − n·π/2, |x| < 10⁵, as a sum of two doubles. π/2 is used in
/// three parts, of which the first two have 33 bits, so that their multiples are exact (Cody and Waite,
/// Software Manual for the Elementary Functions, 1980).
Sum reduced(double x, double n) noexcept {
  const double first = x - n * 0x1.921fb54400000p+0;
  const double second = n * 0x1.0b4611a600000p-34;
  const double high = first - second;
  const double part = high - first;
  const double error = (first - (high - part)) - (second + part);
  const double low = error - n * 0x1.3198a2e037073p-69;
  return exact_sum(high, low);
}

/// The Taylor series of the sine to the power 17 for an argument given as a sum of two doubles, of absolute
/// value up to π/4.
double small_sine(const Sum& x) noexcept {
  const double x2 = x.high * x.high;
  const double x4 = x2 * x2;
  const double series = (-1.0 / 6.0 + x2 * (1.0 / 120.0)) +
                        x4 * ((-1.0 / 5040.0 + x2 * (1.0 / 362880.0)) +
                              x4 * ((-1.0 / 39916800.0 + x2 * (1.0 / 6227020800.0)) +
                                    x4 * (-1.0 / 1307674368000.0 + x2 * (1.0 / 355687428096000.0))));
  return x.high + (x.high * x2 * series + x.low * (1.0 - 0.5 * x2));
}

/// The Taylor series of the cosine to the power 18 for an argument given as a sum of two doubles, of absolute
/// value up to π/4.
double small_cosine(const Sum& x) noexcept {
  const double x2 = x.high * x.high;
  const double x4 = x2 * x2;
  const double series = (1.0 / 24.0 - x2 * (1.0 / 720.0)) +
                        x4 * ((1.0 / 40320.0 - x2 * (1.0 / 3628800.0)) +
                              x4 * ((1.0 / 479001600.0 - x2 * (1.0 / 87178291200.0)) +
                                    x4 * (1.0 / 20922789888000.0 - x2 * (1.0 / 6402373705728000.0))));
  const double half = 0.5 * x2;
  const double high = 1.0 - half;
  return high + (((1.0 - high) - half) + (x4 * series - x.high * x.low));
}

}  // namespace

double exp(double x) noexcept {
  if (!(std::abs(x) < max_table_argument)) return exp_of_draws(x);
  const ScaledExponential e = scaled_exponential(x);
  return e.scale + e.scale * e.excess;
}

double exp_of_draws(double x) noexcept {
  return Sleef_cinz_expd1_u10purec(x);
}

double expm1(double x) noexcept {
  constexpr double small = 0.02;
  if (std::abs(x) < small) return small_expm1(x);
  if (!(std::abs(x) < max_table_argument)) return expm1_of_draws(x);
  const ScaledExponential e = scaled_exponential(x);
  // scale − 1 as a sum of two numbers (Knuth, The Art of Computer Programming 2, 4.2.2, theorem B).
  const double high = e.scale - 1.0;
  const double one = high - e.scale;
  const double low = (e.scale - (high - one)) - (1.0 + one);
  return high + (low + e.scale * e.excess);
}

double expm1_of_draws(double x) noexcept {
  return Sleef_cinz_expm1d1_u10purec(x);
}

double log(double x) noexcept {
  return is_normal_and_positive(x) ? logarithm(x).high : log_of_draws(x);
}
double log_of_draws(double x) noexcept {
  return Sleef_cinz_logd1_u10purec(x);
}
double log1p(double x) noexcept {
  return Sleef_cinz_log1pd1_u10purec(x);
}
double pow(double x, double y) noexcept {
  const double magnitude = std::abs(y);
  if (is_normal_and_positive(x) && magnitude > 1e-100 && magnitude < 1e100) {
    const Sum ln = logarithm(x);
    const double product = y * ln.high;
    if (std::abs(product) < max_table_argument) {
      const Sum of_y = halves(y);
      const Sum of_ln = halves(ln.high);
      const double error =
          ((of_y.high * of_ln.high - product) + of_y.high * of_ln.low + of_y.low * of_ln.high) +
          (of_y.low * of_ln.low + y * ln.low);
      const ScaledExponential e = scaled_exponential(product, error);
      return e.scale + e.scale * e.excess;
    }
  }
  return pow_of_draws(x, y);
}
double pow_of_draws(double x, double y) noexcept {
  return Sleef_cinz_powd1_u10purec(x, y);
}
double cbrt(double x) noexcept {
  return Sleef_cinz_cbrtd1_u10purec(x);
}
double hypot(double x, double y) noexcept {
  return Sleef_cinz_hypotd1_u05purec(x, y);
}
double sin(double x) noexcept {
  return Sleef_cinz_sind1_u10purec(x);
}
double cos(double x) noexcept {
  return Sleef_cinz_cosd1_u10purec(x);
}
double tan(double x) noexcept {
  return Sleef_cinz_tand1_u10purec(x);
}
double asin(double x) noexcept {
  return Sleef_cinz_asind1_u10purec(x);
}

SineAndCosine sine_and_cosine(double x) noexcept {
  constexpr double quarters = 0x1.45f306dc9c883p-1;  // 2/π
  if (!(std::abs(x) < 1e5)) return {sin(x), cos(x)};
  constexpr double to_whole = 0x1.8p52;
  const double n = (x * quarters + to_whole) - to_whole;
  const Sum r = reduced(x, n);
  const double sine = small_sine(r);
  const double cosine = small_cosine(r);
  switch (static_cast<int>(n) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

}  // namespace zerocount::numerics
