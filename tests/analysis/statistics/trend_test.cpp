#include "analysis/statistics/trend.hpp"

#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

RankTrend by_all_pairs(const std::vector<double>& series) {
  RankTrend trend;
  for (std::size_t j = 0; j < series.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      trend.rising += series[j] > series[i];
      trend.falling += series[j] < series[i];
      trend.equal += series[j] == series[i];
    }
  }
  return trend;
}

TEST(Trend, CountsThePairsOfAnySeries) {
  std::mt19937_64 random(41);
  for (int round = 0; round < 200; ++round) {
    std::vector<double> series(random() % 60);
    for (double& value : series)
      value = static_cast<double>(random() % (1 + round));  // with many and with few ties
    const RankTrend expected = by_all_pairs(series), found = rank_trend(series);
    EXPECT_EQ(found.rising, expected.rising);
    EXPECT_EQ(found.falling, expected.falling);
    EXPECT_EQ(found.equal, expected.equal);
  }
}

TEST(Trend, TauIsSciPysWithoutTies) {
  // SciPy 1.10: kendalltau(range(n), x) of x_i = (37i² + 11i) mod 1009, i = 1 … n, which has no ties.
  const auto tau = [](int n) {
    std::vector<double> series;
    for (int i = 1; i <= n; ++i) series.push_back((37 * i * i + 11 * i) % 1009);
    return kendall_tau(rank_trend(series));
  };
  EXPECT_NEAR(tau(5), 1.0, 1e-14);
  EXPECT_NEAR(tau(12), 0.2424242424242424, 1e-14);
  EXPECT_NEAR(tau(40), -0.04871794871794872, 1e-14);
}

TEST(Trend, IsAsOftenPositiveAsNegativeForARandomOrder) {
  std::mt19937_64 random(42);
  std::exponential_distribution<double> interval;
  int rising = 0, falling = 0;
  constexpr int rounds = 10000;
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> series(6);
    for (double& value : series) value = interval(random);
    const RankTrend trend = rank_trend(series);
    rising += trend.rising > trend.falling;
    falling += trend.rising < trend.falling;
  }
  EXPECT_NEAR(rising, falling, 4.0 * std::sqrt(rounds));
}

TEST(Trend, OneValueHasNone) {
  EXPECT_TRUE(std::isnan(kendall_tau(rank_trend({}))));
  const std::vector<double> one{1.0};
  EXPECT_TRUE(std::isnan(kendall_tau(rank_trend(one))));
}

}  // namespace
}  // namespace zerocount::statistics
