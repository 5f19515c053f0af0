#include "analysis/text/percent.hpp"

#include "tests/support/test.hpp"

namespace zerocount::text {
namespace {

TEST(Percent, OfABoundIsRoundedToTheSafeSide) {
  std::mt19937_64 random(96);
  std::uniform_real_distribution<double> exponent(-6.0, 0.0);
  for (int round = 0; round < 2000; ++round) {
    const double missing = std::pow(10.0, exponent(random));
    const double proportion = 1.0 - missing;
    EXPECT_LE(std::stod(percent_at_least(proportion)), 100.0 * proportion + 1e-9);
    EXPECT_GE(std::stod(percent_at_least(proportion)),
              100.0 * proportion - 100.0 * std::max(0.1 * missing, 1e-3));
    EXPECT_GE(std::stod(percent_at_most(missing)), 100.0 * missing - 1e-9);
    EXPECT_LE(std::stod(percent_at_most(missing)), 100.0 * std::max(1.1 * missing, missing + 1e-3));
    EXPECT_LE(std::stod(rounded_down(proportion, 2)), proportion + 1e-9);
    EXPECT_GE(std::stod(rounded_up(proportion, 2)), proportion - 1e-9);
  }
  EXPECT_EQ(percent_at_least(0.999), "99.9 %");
  EXPECT_EQ(percent_at_least(0.99899), "99.89 %");
  EXPECT_EQ(percent_at_least(0.859383), "85.9 %");
  EXPECT_EQ(percent_at_most(0.00299), "0.3 %");
}

TEST(Percent, OfALowerBoundIsNeverAHundredNorOfAnUpperBoundZero) {
  for (const double missing : {1e-9, 1e-12, 1e-15, 1e-17}) {
    EXPECT_LT(std::stod(percent_at_least(1.0 - missing)), 100.0) << missing;
    EXPECT_GT(std::stod(percent_at_most(missing)), 0.0) << missing;
  }
  EXPECT_EQ(percent_at_least(0.0), "0 %");
  EXPECT_EQ(percent_at_most(0.0), "0 %");
  EXPECT_EQ(percent_at_most(1.0), "100 %");
}

TEST(Percent, OfTwoBoundsIsRoundedOutward) {
  EXPECT_EQ(percent_bounds(0.99996, 1.0), "99.9, 100.0");
  EXPECT_EQ(percent_bounds(0.0, 0.00001), "0.0, 0.1");
  EXPECT_EQ(percent_bounds(0.29549, 0.37251), "29.5, 37.3");
  EXPECT_EQ(percent_bounds(0.295, 0.372), "29.5, 37.2");
  EXPECT_EQ(percent_bounds(0.29549, 0.37251, 2, " … "), "29.54 … 37.26");
  EXPECT_EQ(rounded_down(-0.0004, 3), "-0.001");
  EXPECT_EQ(rounded_up(-0.0004, 3), "0.000");
}

TEST(Percent, OfANumberThatWasGivenIsThatNumber) {
  EXPECT_EQ(percent(0.95), "95 %");
  EXPECT_EQ(percent(0.07), "7 %");
  EXPECT_EQ(percent(0.999), "99.9 %");
  EXPECT_EQ(percent(0.99999999), "99.999999 %");
  EXPECT_EQ(percent(0.999999999999), "99.9999999999 %");
  EXPECT_EQ(percent(1.0 / 3.0), "33.3333 %");
  EXPECT_EQ(percent(1e-7), "1e-05 %");
  EXPECT_EQ(percent(1.0), "100 %");
  EXPECT_EQ(percent(0.0), "0 %");
}

}  // namespace
}  // namespace zerocount::text
