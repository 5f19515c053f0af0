// The DAC: rounding to even, clipping at and beyond the range.
#include "core/loop/dac.hpp"

#include <gtest/gtest.h>

namespace zerocount {
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

}  // namespace
}  // namespace zerocount
