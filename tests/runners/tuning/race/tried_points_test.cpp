// The frontier between success and speed. Rates that led a search show that a goal is out of reach; a rate of
// 0 nearly everywhere does not.
#include "runners/tuning/race/candidate.hpp"
#include "tests/support/test.hpp"

namespace zerocount::tuning {
namespace {

const Aim aim{.claims = {{.moves = 0.9}}};

TriedPoint point(double rate, std::int64_t units = 64) {
  TriedPoint tried;
  tried.estimate.rate = tried.estimate.moves = rate;
  tried.estimate.units = units;
  return tried;
}

/// Points over the range of one parameter, at which this is the rate.
template <class Rate>
Landscape landscape(Rate rate, int points = 400) {
  std::vector<TriedPoint> tried;
  for (int i = 0; i < points; ++i) tried.push_back(point(rate((i + 0.5) / points)));
  return landscape_of(aim, tried);
}

TEST(Landscape, LeadsWhereTheRateRisesToItsHighest) {
  EXPECT_TRUE(landscape([](double x) { return 0.6 * std::exp(-8.0 * (x - 0.4) * (x - 0.4)); }).leads());
  // A narrow peak that the search refined: one point in ten lies on it.
  EXPECT_TRUE(landscape([](double x) { return std::max(0.0, 0.7 - 20.0 * std::abs(x - 0.3)); }).leads());
}

TEST(Landscape, LeadsNowhereWhereHardlyAnyMoveMeetsTheGoal) {
  EXPECT_FALSE(landscape([](double) { return 0.0; }).leads());
  // Half of the moves are trivial, and meet it everywhere.
  EXPECT_FALSE(landscape([](double) { return 0.5; }).leads());
  // By chance: one move in 64, wherever one looks.
  EXPECT_FALSE(landscape([](double) { return 1.0 / 64.0; }).leads());
  // A needle that two points met, and that is no slope.
  EXPECT_FALSE(landscape([](double x) { return std::abs(x - 0.08) < 0.003 ? 1.0 : 0.0; }).leads());
  EXPECT_FALSE(landscape([](double x) { return 0.8 * x; }, 5).leads()) << "too few points";
}

// A goal for machines may be met by none where many moves meet it: these lead.
TEST(Landscape, FollowsTheMovesOfAGoalForMachines) {
  const Aim of_machines{.claims = {{.moves = 0.99, .machines = 0.95}}};
  std::vector<TriedPoint> tried;
  for (int i = 0; i < 100; ++i) tried.push_back(point(0.009 * i));
  for (TriedPoint& one : tried) one.estimate.rate = 0.0;
  EXPECT_TRUE(landscape_of(of_machines, tried).leads());
}

TEST(Landscape, DecidesAMissedGoalOnlyTogetherWithTheSearch) {
  const Landscape leads{.points = 100, .telling = 50, .varies = true};
  EXPECT_TRUE((MissedSearch{.landscape = leads}.shows_unreachable()));
  EXPECT_FALSE((MissedSearch{.approaching = true, .landscape = leads}.shows_unreachable()));
  EXPECT_FALSE((MissedSearch{.all_tried = false, .landscape = leads}.shows_unreachable()));
  EXPECT_FALSE(
      (MissedSearch{.landscape = {.points = 100, .telling = 0, .varies = true}}.shows_unreachable()));
}

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
    const std::vector<TriedPoint> frontier = frontier_of(tried, 512);
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
}  // namespace zerocount::tuning
