#include "core/text/number_text.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace zerocount {
namespace {

TEST(NumberText, IsANumberOnlyAsAWhole) {
  EXPECT_EQ(text::parse_number<double>("3.16e-5"), 3.16e-5);
  EXPECT_EQ(text::parse_number<std::int64_t>("-7"), -7);
  for (const char* const other : {"", "3,16", "3.1 ", " 3", "+3", "3e", "x", "1e999"})
    EXPECT_FALSE(text::parse_number<double>(other)) << other;
  EXPECT_FALSE(text::parse_number<std::int64_t>("7.0"));
}

TEST(NumberText, RoundsToTheDoubleNearestToTheDecimalNumber) {
  EXPECT_EQ(text::round_to_digits(1.9999999999999998e-05, 15), 2e-05);
  EXPECT_EQ(text::round_to_digits(-1234567.0, 2), -1200000.0);
  EXPECT_EQ(text::round_to_digits(0.0, 3), 0.0);
  EXPECT_TRUE(std::isnan(text::round_to_digits(std::nan(""), 3)));
  EXPECT_TRUE(std::isinf(text::round_to_digits(std::numeric_limits<double>::infinity(), 3)));
  std::mt19937_64 random(59);
  std::uniform_real_distribution<double> exponent(-300.0, 300.0);
  for (int i = 0; i < 1000; ++i) {
    const double value = std::pow(10.0, exponent(random));
    for (const int digits : {1, 5, 15}) {
      const double rounded = text::round_to_digits(value, digits);
      EXPECT_LE(std::abs(rounded - value), 0.51 * std::pow(10.0, 1 - digits) * value);
      EXPECT_EQ(rounded, std::stod(fmt::format("{:.{}g}", value, digits)));
    }
  }
}

}  // namespace
}  // namespace zerocount
