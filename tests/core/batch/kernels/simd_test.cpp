#include "core/batch/kernels/simd.hpp"

#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Lanes = batch::Simd<2, 1>;

/// A SIMD vector with a different number in each lane, for tests of single lanes.
Lanes lanes_of(double first, double second) {
  Lanes lanes;
  lanes.part[0][0] = first;
  lanes.part[0][1] = second;
  return lanes;
}

double relative_error(double value, long double expected) {
  return static_cast<double>(std::abs(value / expected - 1.0L));
}

TEST(Lanes, ExponentialsAndLogarithmsAreAccurate) {
  Draws draws(1803);
  for (int round = 0; round < 20000; ++round) {
    const long double x = draws.uniform(-690.0, 690.0), a = draws.log_uniform(1e-300, 1e300);
    const Lanes e = exp(lanes_of(0.0, static_cast<double>(x)));
    const Lanes l = numerics::logarithm_by_series(lanes_of(static_cast<double>(a), 1.0));
    ASSERT_LE(relative_error(e.part[0][1], std::exp(x)), 5e-16) << static_cast<double>(x);
    ASSERT_LE(relative_error(l.part[0][0], std::log(a)), 5e-16) << static_cast<double>(a);
    const long double near_one = draws.uniform(0.9, 1.1);
    const Lanes small = numerics::logarithm_by_series(
        lanes_of(static_cast<double>(near_one), std::numeric_limits<double>::min()));
    ASSERT_LE(relative_error(small.part[0][0], std::log(near_one)), 5e-16) << static_cast<double>(near_one);
    ASSERT_EQ(small.part[0][1], std::log(std::numeric_limits<double>::min()));
    ASSERT_EQ(e.part[0][0], 1.0);
    ASSERT_EQ(l.part[0][1], 0.0);
  }
}

TEST(Lanes, PowersAreAccurate) {
  Draws draws(1804);
  for (int round = 0; round < 20000; ++round) {
    const long double a = draws.log_uniform(1e-12, 1e3), n = draws.uniform(1.0, 8.0);
    const Lanes power = pow(lanes_of(static_cast<double>(a), 1.0), Lanes(static_cast<double>(n)));
    const auto logarithm = static_cast<double>(std::abs(n * std::log(a)));
    ASSERT_LE(relative_error(power.part[0][0], std::pow(a, n)), 5e-16 * (1.0 + logarithm))
        << static_cast<double>(a) << ' ' << static_cast<double>(n);
    ASSERT_EQ(power.part[0][1], 1.0);
  }
}

TEST(Lanes, PowersOfZeroSubnormalInfinityAndNaNAreHandled) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(pow(Lanes(0.0), Lanes(1.5)).part[0][0], 0.0);
  EXPECT_LT(pow(Lanes(1e-310), Lanes(1.5)).part[0][0], 1e-300);
  EXPECT_EQ(pow(Lanes(30.0), Lanes(400.0)).part[0][0], infinite);
  EXPECT_TRUE(std::isnan(pow(Lanes(std::nan("")), Lanes(1.5)).part[0][0]));
  EXPECT_FALSE(std::isfinite(pow(Lanes(infinite), Lanes(1.5)).part[0][0]));
}

}  // namespace
}  // namespace zerocount::testing
