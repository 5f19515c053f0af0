// The DAC: rounding to even, clipping at and beyond the range; what it really gives.
#include "core/loop/dac.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace zerocount::loop {
namespace {

TEST(Dac, TwelveBitsReachFromMinus2048To2047) {
  const DacParameters dac;
  EXPECT_EQ(lowest_code(dac), -2048);
  EXPECT_EQ(highest_code(dac), 2047);
}

TEST(Dac, RoundsHalvesToEven) {
  const DacParameters dac{12, 0.5};  // halves of a code are exact in binary
  EXPECT_EQ(convert(dac, 0.25).code, 0);
  EXPECT_EQ(convert(dac, 0.75).code, 2);
  EXPECT_EQ(convert(dac, 1.25).code, 2);
  EXPECT_EQ(convert(dac, -0.25).code, 0);
  EXPECT_EQ(convert(dac, -0.75).code, -2);
  EXPECT_EQ(convert(dac, 0.7500001).code, 2);
  EXPECT_EQ(convert(dac, 0.2500001).code, 1);
}

TEST(Dac, ClipsAndSaysSo) {
  const DacParameters dac{12, 0.5};
  EXPECT_EQ(convert(dac, 2047 * 0.5).code, 2047);
  EXPECT_FALSE(convert(dac, 2047 * 0.5).clipped);
  EXPECT_FALSE(convert(dac, 2047.4 * 0.5).clipped);
  EXPECT_EQ(convert(dac, 2048 * 0.5).code, 2047);
  EXPECT_TRUE(convert(dac, 2048 * 0.5).clipped);
  EXPECT_EQ(convert(dac, -2048 * 0.5).code, -2048);
  EXPECT_FALSE(convert(dac, -2048 * 0.5).clipped);
  EXPECT_EQ(convert(dac, -1e300).code, -2048);
  EXPECT_TRUE(convert(dac, -1e300).clipped);
  EXPECT_EQ(convert(dac, 1e300).torque, 2047 * 0.5);
}

TEST(Dac, TorqueIsTheCodeTimesTheResolution) {
  const DacParameters dac;
  for (int code = -2048; code < 2048; ++code)
    EXPECT_EQ(convert(dac, code * dac.resolution).torque, code * dac.resolution);
}

TEST(Dac, ErrorsDoNotChangeTheCode) {
  const DacParameters ideal;
  DacParameters dac;
  dac.offset = 0.3;
  dac.gain_error = 0.1;
  dac.nonlinearity = 20.0;
  dac.noise = 0.5;
  EXPECT_FALSE(has_errors(ideal));
  std::mt19937 random(2);
  std::uniform_real_distribution<double> torque(-0.6, 0.6);
  for (int i = 0; i < 1000; ++i) {
    const double wanted = torque(random);
    EXPECT_EQ(convert(dac, wanted).code, convert(ideal, wanted).code);
    EXPECT_EQ(convert(dac, wanted).torque, convert(ideal, wanted).torque);
  }
}

TEST(Dac, EachErrorIsOne) {
  EXPECT_TRUE(has_errors({.offset = 1e-9}));
  EXPECT_TRUE(has_errors({.gain_error = -1e-9}));
  EXPECT_TRUE(has_errors({.nonlinearity = 1e-9}));
  EXPECT_TRUE(has_errors({.noise = 1e-9}));
}

TEST(Dac, OffsetAndGainErrorMakeAnotherStraightLine) {
  DacParameters dac;
  dac.offset = -3e-3;
  dac.gain_error = 0.02;
  for (std::int64_t code = -2048; code < 2048; ++code)
    EXPECT_NEAR(torque_with_errors(dac, code), static_cast<double>(code) * 2.4e-4 * 1.02 - 3e-3, 1e-15);
}

TEST(Dac, NonlinearityIsABowBetweenTheEndsOfTheRange) {
  for (const int bits : {2, 8, 12, 16}) {
    DacParameters dac;
    dac.bits = bits;
    dac.resolution = 1.0;
    dac.nonlinearity = 2.5;
    const auto bow = [&](std::int64_t code) {
      return torque_with_errors(dac, code) - static_cast<double>(code);
    };
    const std::int64_t lowest = lowest_code(dac);
    const std::int64_t highest = highest_code(dac);
    EXPECT_EQ(bow(lowest), 0.0);
    EXPECT_EQ(bow(highest), 0.0);
    double largest = 0.0;
    const double rounding = 1e-15 * static_cast<double>(highest);
    for (std::int64_t code = lowest; code <= highest; ++code) {
      EXPECT_NEAR(bow(code), bow(-1 - code), rounding);  // about the middle, −½
      largest = std::max(largest, bow(code));
      if (code > lowest && code < highest) {
        // A parabola: the same bend everywhere, that of a bow 2.5 high over half the range to either side.
        const double half = 0.5 * static_cast<double>(highest - lowest);
        EXPECT_NEAR(bow(code - 1) - 2.0 * bow(code) + bow(code + 1), -2.0 * 2.5 / (half * half),
                    4.0 * rounding);
      }
    }
    EXPECT_EQ(largest, bow(0));
    EXPECT_NEAR(largest, 2.5, 2.5 / std::pow(std::exp2(bits) - 1.0, 2) + rounding);
  }
}

}  // namespace
}  // namespace zerocount::loop
