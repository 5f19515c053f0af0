#include "analysis/text/quantity.hpp"

#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::text {
namespace {

TEST(Quantity, OfALengthReadsBackAndHasOneToThreeDigitsBeforeThePoint) {
  const std::map<std::string, double> sizes{
      {"pm", 1e-12}, {"nm", 1e-9}, {"µm", 1e-6}, {"mm", 1e-3}, {"m", 1.0}};
  testing::Draws draws(62);
  for (int round = 0; round < 2000; ++round) {
    const double value = (draws.chance(0.5) ? 1.0 : -1.0) * std::pow(10.0, draws.uniform(-11.99, 2.99));
    const std::string text = quantity_text(value, "m", 6);
    const std::size_t space = text.find(' ');
    const double number = std::stod(text.substr(0, space));
    ASSERT_TRUE(sizes.contains(text.substr(space + 1))) << text;
    EXPECT_GE(std::abs(number), 0.9999) << text;
    EXPECT_LE(std::abs(number), 1000.0) << text;
    EXPECT_NEAR(number * sizes.at(text.substr(space + 1)), value, 5e-6 * std::abs(value)) << text;
  }
}

TEST(Quantity, HasThePrefixesThatTheFieldWritesWithItsUnit) {
  EXPECT_EQ(quantity_text(1e-5, "rad"), "10 µrad");
  EXPECT_EQ(quantity_text(16000, "Hz"), "16 kHz");
  EXPECT_EQ(quantity_text(5.9e6, "N/m"), "5.9e6 N/m");
  EXPECT_EQ(quantity_text(1000, "m/s^3"), "1000 m/s³");
  EXPECT_EQ(quantity_text(0.0, "m"), "0 m");
  EXPECT_EQ(quantity_text(0.8, "1"), "0.8");
  EXPECT_EQ(quantity_text(1.0, "count"), "1 count");
  EXPECT_EQ(quantity_text(200.0, "count"), "200 counts");
  EXPECT_EQ(quantity_text(std::numeric_limits<double>::quiet_NaN(), "s"), "– s");
}

TEST(Quantity, OfSeveralNumbersHasOnePrefix) {
  EXPECT_EQ(range_text(2e-6, 1.2e-3, "m"), "0.002 … 1.2 mm");
  EXPECT_EQ(range_text(310, 930, "N s/m"), "310 … 930 N s/m");
  EXPECT_EQ(range_text(3.0, 3.0, "s"), "3 s");
  EXPECT_EQ(list_text(std::array{2e-5, 2.1e-5, 0.0}, "m"), "20, 21, 0 µm");
}

}  // namespace
}  // namespace zerocount::text
