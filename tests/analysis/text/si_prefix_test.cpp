#include "analysis/text/si_prefix.hpp"

#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/draws.hpp"

namespace zerocount::text {
namespace {

TEST(SiPrefix, OfAQuantityLeavesOneToThreeDigitsBeforeThePoint) {
  const std::map<std::string, double> sizes{{"pm", 1e-12}, {"nm", 1e-9}, {"µm", 1e-6}, {"mm", 1e-3},
                                            {"m", 1.0},    {"km", 1e3},  {"Mm", 1e6},  {"Gm", 1e9}};
  testing::Draws draws(62);
  for (int round = 0; round < 2000; ++round) {
    const double value = (draws.chance(0.5) ? 1.0 : -1.0) * std::pow(10.0, draws.uniform(-11.99, 11.99));
    const std::string text = with_si_prefix(value, "m");
    const std::size_t space = text.find(' ');
    const double number = std::stod(text.substr(0, space));
    ASSERT_TRUE(sizes.contains(text.substr(space + 1))) << text;
    EXPECT_GE(std::abs(number), 1.0) << text;
    EXPECT_LT(std::abs(number), 1000.0) << text;
    EXPECT_NEAR(number * sizes.at(text.substr(space + 1)), value, 5e-6 * std::abs(value)) << text;
  }
}

TEST(SiPrefix, IsLeftOutWhereNoneFits) {
  EXPECT_EQ(with_si_prefix(0.0, "m"), "0 m");
  EXPECT_EQ(with_si_prefix(1e-15, "m"), "1e-15 m");
  EXPECT_EQ(with_si_prefix(1e-5, "rad"), "10 µrad");
  EXPECT_EQ(with_si_prefix(999.9999e-9, "m"), "1 µm");
}

}  // namespace
}  // namespace zerocount::text
