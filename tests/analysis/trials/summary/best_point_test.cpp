#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/point_accumulator.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "tests/analysis/trials/summary/swept_study.hpp"

namespace zerocount::summary {
namespace {

measures::PointSummary point_with(std::int64_t successes, std::int64_t trials) {
  measures::PointAccumulator point;
  for (std::int64_t i = 0; i < trials; ++i) {
    trial::MoveOutcome move;
    move.outcome = i < successes ? trial::Outcome::zero_count : trial::Outcome::one_count;
    point.add({{move}}, {});
  }
  return point.statistics();
}

TEST(BestPoint, HasTheHighestRate) {
  const StudySummary study = swept_study({point_with(3, 10), point_with(9, 10), point_with(9, 10)});
  EXPECT_EQ(points_by_merit(study).front(), 1);
  EXPECT_EQ(points_by_merit(study), (std::vector<std::int64_t>{1, 2, 0}));
}

TEST(BestPoint, TheSimplestOfEqualPointsIsTheBest) {
  StudySummary study = swept_study({point_with(9, 10), point_with(9, 10)});
  study.axes.push_back({"controller.kp", "N m/count", "", study::SweepAxis::Kind::number, {0.1, 0.0}, {}});
  EXPECT_EQ(points_by_merit(study).front(), 1);
}

TEST(BestPoint, LeavesOutPointsWithoutTrials) {
  EXPECT_EQ(points_by_merit(swept_study({point_with(0, 0), point_with(1, 10)})),
            std::vector<std::int64_t>{1});
}

TEST(BestPoint, ASinglePointHasItsOwnBounds) {
  const measures::PointSummary point = point_with(27, 30);
  EXPECT_EQ(goal::claim_of_chosen(point, 1, false).success_at_least, point.claim.success_at_least);
  const statistics::ConfidenceInterval bounds = goal::bounds_of_chosen(point, 1, false, 0.95);
  EXPECT_EQ(bounds.low, point.success_rate().clopper_pearson.low);
  EXPECT_EQ(bounds.high, point.success_rate().clopper_pearson.high);
}

// Twenty points that are equally good: the best of them looks better than it is.
TEST(BestPoint, BoundsAllowForTheChoice) {
  std::mt19937_64 random(166);
  constexpr double truth = 0.8;
  constexpr int rounds = 300, trials = 60;
  std::binomial_distribution<std::int64_t> successes(trials, truth);
  int too_high = 0, too_high_alone = 0;
  for (int round = 0; round < rounds; ++round) {
    std::vector<measures::PointSummary> points;
    for (int i = 0; i < 20; ++i) points.push_back(point_with(successes(random), trials));
    const measures::PointSummary& best =
        points[static_cast<std::size_t>(points_by_merit(swept_study(points)).front())];
    too_high += goal::claim_of_chosen(best, points.size(), false).success_at_least > truth;
    too_high_alone += best.claim.success_at_least > truth;
    EXPECT_LE(goal::bounds_of_chosen(best, points.size(), false, 0.95).low,
              best.success_rate().clopper_pearson.low);
  }
  EXPECT_LE(too_high, 0.05 * rounds + 3.0 * 3.8);  // three standard errors
  EXPECT_GE(too_high_alone, 0.3 * rounds);
}

}  // namespace
}  // namespace zerocount::summary
