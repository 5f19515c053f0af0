#include "analysis/jerks/laplace_trend.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/failure/failure.hpp"

namespace zerocount::jerks {
namespace {

TEST(LaplaceTrend, HasTheVarianceOfAllChoicesOfInstants) {
  // Every choice of n of M instants, enumerated as the bits of a number.
  for (const int size : {5, 9, 12}) {
    for (const int events : {1, 3, 4}) {
      double sum = 0.0, squares = 0.0;
      int choices = 0;
      double variance = 0.0;
      for (unsigned bits = 0; bits < 1U << size; ++bits) {
        std::vector<std::int64_t> instants;
        for (int i = 0; i < size; ++i) {
          if ((bits >> i & 1U) != 0) instants.push_back(i + 1);
        }
        if (std::ssize(instants) != events) continue;
        const LaplaceTerm term = laplace_term(instants, size);
        ++choices;
        sum += term.excess;
        squares += term.excess * term.excess;
        variance = term.variance;
      }
      EXPECT_NEAR(sum, 0.0, 1e-9);
      EXPECT_NEAR(squares / choices, variance, 1e-9) << events << " of " << size;
    }
  }
}

TEST(LaplaceTrend, IsLaplacesStatisticForManyInstants) {
  const std::vector<std::int64_t> instants{100'000, 250'000, 300'000, 900'000};
  const double laplace = (1.55 / 4.0 - 0.5) / std::sqrt(1.0 / (12.0 * 4.0));
  EXPECT_NEAR(laplace_score(laplace_term(instants, 1'000'000)), laplace, 1e-5);
}

TEST(LaplaceTrend, OfNothingIsNothing) {
  EXPECT_TRUE(std::isnan(laplace_score(laplace_term({}, 100))));
  EXPECT_TRUE(std::isnan(laplace_score({})));
  const std::vector<std::int64_t> every{1, 2, 3};
  EXPECT_TRUE(std::isnan(laplace_score(laplace_term(every, 3))));
  LaplaceSum sum(0.95);
  sum.add({});
  EXPECT_EQ(sum.summary().moves, 0);
  EXPECT_TRUE(std::isnan(sum.summary().summed));
  EXPECT_THROW(LaplaceSum(1.0), Failure);
}

/// Moves of 600 instants with a chance of an event of 0.02·exp(−decay·instant/600) at each.
LaplaceSummary simulated(double decay, int moves, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform;
  LaplaceSum sum(0.95);
  for (int move = 0; move < moves; ++move) {
    std::vector<std::int64_t> instants;
    for (int i = 1; i <= 600; ++i) {
      if (uniform(random) < 0.02 * std::exp(-decay * i / 600.0)) instants.push_back(i);
    }
    sum.add(laplace_term(instants, 600));
  }
  return sum.summary();
}

TEST(LaplaceTrend, RaisesFalseAlarmsNoMoreOftenThanItSays) {
  std::mt19937_64 random(102);
  constexpr int rounds = 600;
  int alarms = 0, stouffer_alarms = 0;
  std::int64_t tested = 0, slowing = 0, quickening = 0;
  for (int round = 0; round < rounds; ++round) {
    const LaplaceSummary summary = simulated(0.0, 10, random);
    alarms += summary.p_slowing < 0.05;
    stouffer_alarms += summary.stouffer < -1.6449;
    tested += summary.tested;
    slowing += summary.slowing;
    quickening += summary.quickening;
  }
  const double three_sigma = 3.0 * std::sqrt(0.05 * 0.95 * rounds);
  EXPECT_NEAR(alarms, 0.05 * rounds, three_sigma);
  EXPECT_NEAR(stouffer_alarms, 0.05 * rounds, three_sigma);
  const auto n = static_cast<double>(tested);
  EXPECT_NEAR(static_cast<double>(slowing), 0.05 * n, 3.0 * std::sqrt(0.05 * 0.95 * n));
  EXPECT_NEAR(static_cast<double>(quickening), 0.05 * n, 3.0 * std::sqrt(0.05 * 0.95 * n));
}

TEST(LaplaceTrend, FindsAndTellsTheDirectionOfATrend) {
  std::mt19937_64 random(103);
  const LaplaceSummary slowing = simulated(2.0, 40, random);
  EXPECT_LT(slowing.summed, -5.0);
  EXPECT_LT(slowing.p_slowing, 1e-6);
  EXPECT_GT(slowing.slowing, slowing.quickening);
  const LaplaceSummary quickening = simulated(-1.0, 40, random);
  EXPECT_GT(quickening.summed, 3.0);
  EXPECT_GT(quickening.p_slowing, 0.999);
}

}  // namespace
}  // namespace zerocount::jerks
