// The encoder: floor, at edges and below zero.
#include "core/loop/encoder.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace zerocount::loop {
namespace {

TEST(Encoder, ResolutionIsARevolutionOverTheCounts) {
  EXPECT_DOUBLE_EQ(fine_encoder({}, 0.0).resolution, 2.0 * std::numbers::pi / 1620000);
}

TEST(Encoder, StartsAtCountZeroForEveryPhase) {
  for (const double phase : {0.0, 0.25, 0.5, 0.999999})
    EXPECT_EQ(read_count(fine_encoder({}, phase), 0.0), 0);
}

TEST(Encoder, ChangesCountAtTheEdgeAndNotBefore) {
  const Encoder encoder = fine_encoder({}, 0.25);
  for (const std::int64_t n : {-3, -1, 0, 1, 2, 1000}) {
    const double edge = (static_cast<double>(n) - 0.25) * encoder.resolution;
    EXPECT_EQ(read_count(encoder, edge + 1e-6 * encoder.resolution), n);
    EXPECT_EQ(read_count(encoder, edge - 1e-6 * encoder.resolution), n - 1);
  }
}

TEST(Encoder, TruncatesDownwardsBelowZero) {
  const Encoder encoder{1.0, 0.0};
  EXPECT_EQ(read_count(encoder, -0.0), 0);
  EXPECT_EQ(read_count(encoder, -1e-9), -1);
  EXPECT_EQ(read_count(encoder, -1.0), -1);
  EXPECT_EQ(read_count(encoder, -1.5), -2);
}

TEST(Encoder, CountDiffersFromThePositionByLessThanOneCount) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-10.0, 10.0);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const Encoder encoder = coarse_encoder({}, unit(random));
    const double theta = angle(random);
    const double remainder =
        theta / encoder.resolution + encoder.phase - static_cast<double>(read_count(encoder, theta));
    EXPECT_GE(remainder, 0.0);
    EXPECT_LT(remainder, 1.0);
  }
}

}  // namespace
}  // namespace zerocount::loop
