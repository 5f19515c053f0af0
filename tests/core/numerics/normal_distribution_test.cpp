// The quick quantile of the standard normal distribution against that of Boost.Math, bit by bit.
#include "core/numerics/normal_distribution.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

namespace zerocount::numerics {
namespace {

void expect_same_bits(double p) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(standard_normal_quantile(p)),
            std::bit_cast<std::uint64_t>(normal_quantile(p)))
      << p;
}

TEST(NormalQuantile, HasTheBitsOfBoost) {
  std::mt19937_64 random(64);
  for (int i = 0; i < 200'000; ++i) {
    const double p = (static_cast<double>(random() >> 12) + 0.5) * 0x1p-52;
    const double in_tail = std::ldexp(p, -static_cast<int>(random() % 20));
    expect_same_bits(p);
    expect_same_bits(in_tail);
    if (in_tail >= 0x1p-53) expect_same_bits(1.0 - in_tail);
  }
}

TEST(NormalQuantile, HasTheBitsOfBoostWhereTheApproximationsMeet) {
  const double far = 0.5 * std::exp(-9.0);
  for (const double meet : {0x1p-53, far, 0.125, 0.25, 0.5}) {
    double p = meet;
    for (int i = 0; i < 20; ++i) p = std::nextafter(p, 0.0);
    for (int i = 0; i < 40; ++i, p = std::nextafter(p, 1.0)) {
      expect_same_bits(p);
      if (p >= 0x1p-53) expect_same_bits(1.0 - p);
    }
  }
}

}  // namespace
}  // namespace zerocount::numerics
