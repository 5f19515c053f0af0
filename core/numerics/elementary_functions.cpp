#include "core/numerics/elementary_functions.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include <sleef.h>

#include "core/numerics/exponential_table.hpp"

namespace zerocount::numerics {
namespace {

/// Largest |x| for which no intermediate value overflows or is subnormal.
constexpr double max_table_argument = 700.0;

/// exp(x) = scale·(1 + excess), with scale = 2^(k/128) from the table and |excess| < 0.003 (Tang, ACM Trans.
/// Math. Softw. 15 (1989) 144). The polynomial is the series of exp(r) − 1, |r| ≤ ln 2/256, to r⁵.
struct ScaledExponential {
  double scale;
  double excess;
};

ScaledExponential scaled_exponential(double x) noexcept {
  constexpr double to_whole = 0x1.8p52;  // a number so large that its last bit is 1
  const double shifted = x * steps_per_unit + to_whole;
  const std::int64_t steps = std::bit_cast<std::int64_t>(shifted) - std::bit_cast<std::int64_t>(to_whole);
  const double whole = shifted - to_whole;
  const double r = (x - whole * step_high) - whole * step_low;
  const PowerOfTwo& power = powers_of_two[static_cast<std::size_t>(steps & (table_steps - 1))];
  const auto doublings = static_cast<std::uint64_t>(steps >> 7);
  const double r2 = r * r;
  const double rest = r2 * ((1.0 / 2.0 + r * (1.0 / 6.0)) + r2 * (1.0 / 24.0 + r * (1.0 / 120.0)));
  return {std::bit_cast<double>(std::bit_cast<std::uint64_t>(power.value) + (doublings << 52)),
          power.tail + r + rest};
}

/// The series to x⁷, for |x| < 0.02.
double small_expm1(double x) noexcept {
  const double x2 = x * x;
  const double high = (1.0 / 24.0 + x * (1.0 / 120.0)) + x2 * (1.0 / 720.0 + x * (1.0 / 5040.0));
  return x + x2 * ((1.0 / 2.0 + x * (1.0 / 6.0)) + x2 * high);
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
  if (!(std::abs(x) < max_table_argument)) return Sleef_cinz_expm1d1_u10purec(x);
  const ScaledExponential e = scaled_exponential(x);
  // scale − 1 as a sum of two numbers (Knuth, The Art of Computer Programming 2, 4.2.2, theorem B).
  const double high = e.scale - 1.0;
  const double one = high - e.scale;
  const double low = (e.scale - (high - one)) - (1.0 + one);
  return high + (low + e.scale * e.excess);
}

double log(double x) noexcept {
  return Sleef_cinz_logd1_u10purec(x);
}
double log1p(double x) noexcept {
  return Sleef_cinz_log1pd1_u10purec(x);
}
double pow(double x, double y) noexcept {
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

}  // namespace zerocount::numerics
