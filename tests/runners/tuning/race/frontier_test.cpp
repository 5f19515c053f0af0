// The frontier between success and speed.
#include "runners/tuning/race/frontier.hpp"

#include <random>

#include <gtest/gtest.h>

namespace zerocount::testing {
namespace {

using tuning::TriedPoint;

TEST(Frontier, HasThePointsThatNoOtherBeatsInBoth) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> number(0, 30);
  for (int round = 0; round < 50; ++round) {
    std::vector<TriedPoint> tried;
    for (int i = 0; i < 60; ++i) {
      TriedPoint point{{double(i)}, {}};
      point.estimate = {number(random) / 30.0, 0.0, number(random) * 0.01, number(random) < 25 ? 512 : 64};
      tried.push_back(point);
    }
    const std::vector<TriedPoint> frontier = tuning::frontier_of(tried, 512);
    const auto is_on_frontier = [&](const TriedPoint& one) {
      return std::ranges::any_of(frontier, [&](const TriedPoint& other) {
        return other.estimate.rate == one.estimate.rate && other.estimate.criterion == one.estimate.criterion;
      });
    };
    for (const TriedPoint& one : tried) {
      if (one.estimate.units < 512) continue;
      const bool beaten = std::ranges::any_of(tried, [&](const TriedPoint& other) {
        return other.estimate.units >= 512 && other.estimate.rate >= one.estimate.rate &&
               other.estimate.criterion <= one.estimate.criterion &&
               (other.estimate.rate > one.estimate.rate || other.estimate.criterion < one.estimate.criterion);
      });
      EXPECT_EQ(is_on_frontier(one), !beaten);
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
