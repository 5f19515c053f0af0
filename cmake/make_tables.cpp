// Prints the tables of exp and log (elementary_tables.hpp) as C++, each number rounded from 200 bits.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "core/numerics/elementary_tables.hpp"

namespace {

using namespace zerocount::numerics;
using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<200, boost::multiprecision::digit_base_2>>;

/// x, rounded to a multiple of 2⁻ᵇⁱᵗˢ.
double rounded(const Wide& x, int bits) {
  return ldexp(rint(ldexp(x, bits)), -bits).convert_to<double>();
}

void print_power_of_two(int i) {
  const Wide power = exp2(Wide(i) / table_steps);
  const double value = power.convert_to<double>();
  std::printf("{%a, %a},\n", value, (power / value - 1).convert_to<double>());
}

void print_logarithm(std::uint64_t i) {
  const std::uint64_t start = logarithm_start + (i << logarithm_interval_bits);
  const double middle = std::bit_cast<double>(start + (std::uint64_t{1} << (logarithm_interval_bits - 1)));
  const double reciprocal = rounded(1 / Wide(middle), middle > 1.0 ? 24 : 23);
  const Wide logarithm = log(1 / Wide(reciprocal));
  const double high = rounded(logarithm, 42);
  std::printf("{%a, %a, %a},\n", reciprocal, high, (logarithm - high).convert_to<double>());
}

}  // namespace

int main() {
  std::puts("#include \"core/numerics/elementary_tables.hpp\"\nnamespace zerocount::numerics {");
  std::puts("const std::array<PowerOfTwo, table_steps> powers_of_two{{");
  for (int i = 0; i < table_steps; ++i) print_power_of_two(i);
  std::puts("}};\nconst std::array<LogarithmStep, logarithm_steps> logarithms{{");
  for (std::uint64_t i = 0; i < logarithm_steps; ++i) print_logarithm(i);
  std::puts("}};\n}");
}
