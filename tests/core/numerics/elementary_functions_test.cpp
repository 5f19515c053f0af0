#include "core/numerics/elementary_functions.hpp"

#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

struct Function {
  const char* name;
  double (*of)(double) noexcept;
  /// The C library's function in long double, with 11 more bits, with which the function is compared.
  long double (*judge)(long double);
  double low, high;
};

const Function functions[] = {
    {"exp", numerics::exp, std::exp, -700.0, 700.0}, {"expm1", numerics::expm1, std::expm1, -40.0, 40.0},
    {"log", numerics::log, std::log, 1e-3, 1e3},     {"log1p", numerics::log1p, std::log1p, -0.9, 10.0},
    {"cbrt", numerics::cbrt, std::cbrt, -1e3, 1e3},  {"sin", numerics::sin, std::sin, -100.0, 100.0},
    {"cos", numerics::cos, std::cos, -100.0, 100.0}, {"tan", numerics::tan, std::tan, -100.0, 100.0},
    {"asin", numerics::asin, std::asin, -1.0, 1.0},
};

/// Distance in units of the last place of the judge's value.
double distance(double value, long double expected) {
  const double magnitude = std::abs(static_cast<double>(expected));
  const double unit = std::nextafter(magnitude, std::numeric_limits<double>::infinity()) - magnitude;
  return static_cast<double>(std::abs(value - expected)) / unit;
}

TEST(ElementaryFunctions, AreAccurateToTwoUlp) {
  Draws draws(1801);
  for (const Function& function : functions) {
    for (int round = 0; round < 3000; ++round) {
      const double x = draws.uniform(function.low, function.high);
      ASSERT_LE(distance(function.of(x), function.judge(x)), 2.0) << function.name << " of " << x;
    }
  }
}

// Densely, and where the table, the series and the functions for large arguments meet.
TEST(ElementaryFunctions, ExponentialsAreAccurateToOneUlp) {
  Draws draws(1804);
  for (const double most : {1e-9, 0.0027, 0.0054, 0.02, 0.025, 0.1, 0.7, 3.0, 40.0, 699.0}) {
    for (int round = 0; round < 20000; ++round) {
      const double x = draws.uniform(-most, most);
      ASSERT_LE(distance(numerics::exp(x), std::exp(static_cast<long double>(x))), 0.52) << x;
      ASSERT_LE(distance(numerics::expm1(x), std::expm1(static_cast<long double>(x))), 1.0) << x;
    }
  }
  for (const double x : {0.0, -0.0, 1e-300, -1e-300}) EXPECT_EQ(numerics::expm1(x), x);
  EXPECT_EQ(numerics::exp(0.0), 1.0);
}

TEST(ElementaryFunctions, LogarithmsAndPowersAreAccurateToOneUlp) {
  Draws draws(1805);
  for (const double range : {1e-12, 1e-6, 1e-3, 0.01, 0.4, 3.0, 40.0, 690.0}) {
    for (int round = 0; round < 20000; ++round) {
      const double x = std::exp(draws.uniform(-range, range));
      const double y = draws.uniform(-1.0, 1.0) * std::min(690.0 / std::abs(std::log(x)), 1e6);
      const long double wide_x = x;
      ASSERT_LE(distance(numerics::log(x), std::log(wide_x)), 0.52) << x;
      ASSERT_LE(distance(numerics::pow(x, y), std::pow(wide_x, static_cast<long double>(y))), 0.54)
          << x << ' ' << y;
    }
  }
}

TEST(ElementaryFunctions, SineAndCosineAreAccurateToOneUlp) {
  Draws draws(1806);
  const auto expect_both = [](double x) {
    const long double wide = x;
    const numerics::SineAndCosine both = numerics::sine_and_cosine(x);
    ASSERT_LE(distance(both.sine, std::sin(wide)), 1.0) << x;
    ASSERT_LE(distance(both.cosine, std::cos(wide)), 1.0) << x;
  };
  for (const double range : {1e-9, 0.1, 0.79, 1.6, 100.0, 99999.0, 1e7})
    for (int round = 0; round < 20000; ++round) expect_both(draws.uniform(-range, range));
  // Beside the zeros.
  for (int quarter = -60000; quarter < 60000; quarter += 7) expect_both(quarter * 0.5 * std::numbers::pi);
}

TEST(ElementaryFunctions, PowAndHypotAreAccurateToTwoUlp) {
  Draws draws(1802);
  for (int round = 0; round < 3000; ++round) {
    const double x = draws.uniform(1e-3, 30.0), y = draws.uniform(-20.0, 20.0);
    const long double wide_x = x, wide_y = y;
    ASSERT_LE(distance(numerics::pow(x, y), std::pow(wide_x, wide_y)), 2.0) << x << ' ' << y;
    ASSERT_LE(distance(numerics::hypot(x, y), std::hypot(wide_x, wide_y)), 2.0) << x << ' ' << y;
  }
  EXPECT_EQ(numerics::pow(3.0, 5.0), 243.0);
  EXPECT_EQ(numerics::pow(3.0, -1.0), 1.0 / 3.0);
}

TEST(ElementaryFunctions, AreCorrectAtTheirLimits) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(numerics::exp(0.0), 1.0);
  EXPECT_EQ(numerics::exp(-1e4), 0.0);
  EXPECT_EQ(numerics::exp(1e4), infinite);
  EXPECT_EQ(numerics::log(0.0), -infinite);
  EXPECT_EQ(numerics::log(1.0), 0.0);
  EXPECT_TRUE(std::isnan(numerics::log(-1.0)));
  EXPECT_TRUE(std::isnan(numerics::exp(std::nan(""))));
  EXPECT_EQ(numerics::expm1(-infinite), -1.0);
  EXPECT_EQ(numerics::log1p(-1.0), -infinite);
  EXPECT_EQ(numerics::pow(0.0, 0.0), 1.0);
  EXPECT_EQ(numerics::pow(0.0, -1.0), infinite);
  EXPECT_EQ(numerics::hypot(3.0, 4.0), 5.0);
  EXPECT_EQ(numerics::sin(0.0), 0.0);
  EXPECT_TRUE(std::isnan(numerics::sin(infinite)));
}

}  // namespace
}  // namespace zerocount::testing
