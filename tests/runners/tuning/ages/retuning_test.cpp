// Intervals of a life between two tunings.
#include "runners/tuning/ages/retuning.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/failure/failure.hpp"

namespace zerocount::testing {
namespace {

using tuning::intervals_of_life;
using tuning::LifeInterval;

TEST(Retuning, IntervalsEndAtMultiplesAndHaveTheAgesBetween) {
  const std::vector<LifeInterval> found = intervals_of_life({{0.0, 1.0e5, 1.2e5, 3.5e5}, "cycles"}, 1.0e5);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0].ages, (std::vector{0.0, 1.0e5}));
  EXPECT_EQ(found[1].ages, (std::vector{1.0e5, 1.2e5, 2.0e5}));
  EXPECT_EQ(found[2].ages, (std::vector{2.0e5, 3.0e5}));
  EXPECT_EQ(found[3].ages, (std::vector{3.0e5, 3.5e5}));
}

// 7 times 0.3 is 2.0999999999999996 in binary numbers.
TEST(Retuning, MultiplesOfDecimalFractionsAreThoseThatAUserWrites) {
  for (const int tenths : {1, 3, 7, 9}) {
    for (int count = 2; count <= 40; ++count) {
      const double life = tenths * count / 10.0;
      const std::vector<LifeInterval> found = intervals_of_life({{0.0, life}, "years"}, tenths / 10.0);
      ASSERT_EQ(std::ssize(found), count) << tenths;
      for (int i = 0; i < count; ++i)
        EXPECT_EQ(found[static_cast<std::size_t>(i)].ages,
                  (std::vector{tenths * i / 10.0, tenths * (i + 1) / 10.0}));
    }
  }
}

TEST(Retuning, IntervalsCoverTheLifeOnce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    study::Ages ages;
    for (double age = uniform(random) < 0.5 ? 0.0 : uniform(random); std::ssize(ages.at) < 5;
         age += 0.01 + uniform(random))
      ages.at.push_back(age);
    const double life = ages.at.back() - ages.at.front();
    const double every = life * (0.05 + 0.9 * uniform(random));
    std::vector<LifeInterval> found;
    try {
      found = intervals_of_life(ages, every);
    } catch (const Failure&) {  // no multiple lies within the life
      EXPECT_GT(std::floor(ages.at.front() / every) + 1.0, ages.at.back() / every - 1.0);
      continue;
    }
    EXPECT_EQ(found.front().from(), ages.at.front());
    EXPECT_EQ(found.back().to(), ages.at.back());
    std::size_t inner = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_TRUE(std::ranges::is_sorted(found[k].ages));
      EXPECT_LE(found[k].to() - found[k].from(), every * (1.0 + 1e-10));
      inner += found[k].ages.size() - 2;
      if (k > 0) {
        EXPECT_EQ(found[k].from(), found[k - 1].to());
        EXPECT_NEAR(std::remainder(found[k].from(), every), 0.0, 1e-9);
      }
    }
    EXPECT_EQ(inner, ages.at.size() - 2);
  }
}

TEST(Retuning, RefusesOneIntervalAndVeryMany) {
  const study::Ages ages{{0.0, 1.0e6}, "cycles"};
  for (const double every : {1.0e6, 2.0e6, 1.0})
    EXPECT_THROW(intervals_of_life(ages, every), Failure) << every;
  EXPECT_EQ(intervals_of_life(ages, 2.0e4).size(), 50U);
}

// A budget that is not enough for all intervals serves the last ones, as many as possible.
TEST(Retuning, ASmallBudgetServesTheLastIntervals) {
  const std::vector<std::int64_t> least{400, 100, 300, 200};
  const std::vector<std::pair<std::int64_t, std::size_t>> expected{
      {0, 4}, {199, 4}, {200, 3}, {499, 3}, {500, 2}, {599, 2}, {600, 1}, {999, 1}, {1000, 0}, {9999, 0}};
  for (const auto& [trials, first] : expected)
    EXPECT_EQ(tuning::first_affordable(least, trials), first) << trials;
}

}  // namespace
}  // namespace zerocount::testing
