// The functions of <cmath> that this program has in place of those of the C library.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/draws.hpp"

namespace zerocount::testing {
namespace {

struct Function {
  const char* name;
  double (*of)(double);
  long double (*judge)(long double);  ///< of the C library, with 11 bits more
  double low, high;
};

const Function functions[] = {
    {"exp", std::exp, std::exp, -700.0, 700.0},       {"exp2", std::exp2, std::exp2, -1000.0, 1000.0},
    {"expm1", std::expm1, std::expm1, -40.0, 40.0},   {"log", std::log, std::log, 1e-3, 1e3},
    {"log2", std::log2, std::log2, 1e-3, 1e3},        {"log10", std::log10, std::log10, 1e-3, 1e3},
    {"log1p", std::log1p, std::log1p, -0.9, 10.0},    {"cbrt", std::cbrt, std::cbrt, -1e3, 1e3},
    {"sin", std::sin, std::sin, -100.0, 100.0},       {"cos", std::cos, std::cos, -100.0, 100.0},
    {"tan", std::tan, std::tan, -100.0, 100.0},       {"asin", std::asin, std::asin, -1.0, 1.0},
    {"acos", std::acos, std::acos, -1.0, 1.0},        {"atan", std::atan, std::atan, -50.0, 50.0},
    {"sinh", std::sinh, std::sinh, -50.0, 50.0},      {"cosh", std::cosh, std::cosh, -50.0, 50.0},
    {"tanh", std::tanh, std::tanh, -10.0, 10.0},      {"asinh", std::asinh, std::asinh, -1e3, 1e3},
    {"acosh", std::acosh, std::acosh, 1.0, 1e3},      {"atanh", std::atanh, std::atanh, -1.0, 1.0},
    {"erf", std::erf, std::erf, -6.0, 6.0},           {"erfc", std::erfc, std::erfc, -6.0, 26.0},
    {"tgamma", std::tgamma, std::tgamma, 0.1, 170.0},
};

/// Distance in units of the last place of the judge's value.
double distance(double value, long double expected) {
  const double magnitude = std::abs(static_cast<double>(expected));
  const double unit = std::nextafter(magnitude, std::numeric_limits<double>::infinity()) - magnitude;
  return static_cast<double>(std::abs(value - expected)) / unit;
}

TEST(ElementaryFunctions, AreWithinAFewUnitsOfTheLastPlace) {
  Draws draws(1801);
  for (const Function& function : functions) {
    for (int round = 0; round < 3000; ++round) {
      const double x = draws.uniform(function.low, function.high);
      ASSERT_LE(distance(function.of(x), function.judge(x)), 2.0) << function.name << " of " << x;
    }
  }
}

TEST(ElementaryFunctions, OfTwoArgumentsAreTooAndPowersOfWholeNumbersAreExact) {
  Draws draws(1802);
  for (int round = 0; round < 3000; ++round) {
    const double x = draws.uniform(1e-3, 30.0), y = draws.uniform(-20.0, 20.0);
    const long double wide_x = x, wide_y = y;
    ASSERT_LE(distance(std::pow(x, y), std::pow(wide_x, wide_y)), 2.0) << x << ' ' << y;
    ASSERT_LE(distance(std::atan2(y, x), std::atan2(wide_y, wide_x)), 2.0) << x << ' ' << y;
    ASSERT_LE(distance(std::hypot(x, y), std::hypot(wide_x, wide_y)), 2.0) << x << ' ' << y;
  }
  volatile double three = 3.0;  // not folded by the compiler
  EXPECT_EQ(std::pow(three, 5.0), 243.0);
  EXPECT_EQ(std::pow(three, -1.0), 1.0 / 3.0);
}

TEST(ElementaryFunctions, HaveTheirLimits) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  volatile double zero = 0.0;
  EXPECT_EQ(std::exp(zero), 1.0);
  EXPECT_EQ(std::exp(-1e4 + zero), 0.0);
  EXPECT_EQ(std::exp(1e4 + zero), infinite);
  EXPECT_EQ(std::log(zero), -infinite);
  EXPECT_EQ(std::log(zero + 1.0), 0.0);
  EXPECT_TRUE(std::isnan(std::log(zero - 1.0)));
  EXPECT_TRUE(std::isnan(std::exp(std::nan("") + zero)));
  EXPECT_EQ(std::expm1(zero - infinite), -1.0);
  EXPECT_EQ(std::log1p(zero - 1.0), -infinite);
  EXPECT_EQ(std::pow(zero, 0.0), 1.0);
  EXPECT_EQ(std::pow(zero, -1.0), infinite);
  EXPECT_EQ(std::hypot(zero + 3.0, 4.0), 5.0);
  EXPECT_EQ(std::sin(zero), 0.0);
  EXPECT_TRUE(std::isnan(std::sin(zero + infinite)));
  EXPECT_EQ(std::atan2(zero, -1.0), std::acos(zero - 1.0));
  EXPECT_EQ(std::tanh(zero + infinite), 1.0);
  EXPECT_TRUE(std::isfinite(std::cosh(zero + 709.0)));
}

}  // namespace
}  // namespace zerocount::testing
