#include "analysis/iso230/point_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/statistics/sums/histogram.hpp"

namespace zerocount::iso230 {
namespace {

/// NaN for NaN.
bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

TEST(ValueStatistics, AreThoseOfATally) {
  std::mt19937_64 random(3);
  for (const std::size_t n : {1U, 2U, 5U, 6U, 40U, 73U, 74U, 500U}) {
    std::vector<double> values(n);
    statistics::Histogram<double> histogram;
    for (double& value : values) {
      value = 0.25 * static_cast<double>(random() % 64) - 3.0;
      histogram.add(value);
    }
    const ValueStatistics result = statistics_of(values);
    EXPECT_EQ(result.n, std::ssize(values));
    EXPECT_DOUBLE_EQ(result.mean, statistics::mean(histogram));
    EXPECT_EQ(result.max, statistics::largest(histogram));
    for (const auto& [actual, expected] : {std::pair{result.median, statistics::quantile(histogram, 0.5)},
                                           {result.p95, statistics::quantile(histogram, 0.95)}}) {
      EXPECT_EQ(actual.value, expected.value);
      EXPECT_TRUE(same(actual.low, expected.low));
      EXPECT_TRUE(same(actual.high, expected.high));
    }
  }
}

TEST(ValueStatistics, HaveBoundsOfTheConfidenceAskedFor) {
  std::vector<double> values;
  statistics::Histogram<double> histogram;
  for (int i = 0; i < 90; ++i) {
    values.push_back(i * i % 97);
    histogram.add(values.back());
  }
  const ValueStatistics result = statistics_of(values, 0.5);
  EXPECT_EQ(result.median.low, statistics::quantile(histogram, 0.5, 0.5).low);
  EXPECT_EQ(result.p95.high, statistics::quantile(histogram, 0.95, 0.5).high);
  EXPECT_GT(result.median.low, statistics_of(values).median.low);
}

TEST(ValueStatistics, LeaveOutWhatIsNotDefined) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const ValueStatistics result = statistics_of({none, 3.0, none, 1.0, 2.0});
  EXPECT_EQ(result.n, 3);
  EXPECT_EQ(result.mean, 2.0);
  EXPECT_EQ(result.median.value, 2.0);
  const ValueStatistics empty = statistics_of({none});
  EXPECT_EQ(empty.n, 0);
  for (const ValueStatisticField& field : value_statistic_fields()) {
    EXPECT_TRUE(std::isnan(field.value(empty))) << field.name;
  }
}

TEST(ValueStatistics, DoNotDependOnTheOrderOfTheTrials) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(1e-6, 1e-7);
  std::vector<double> values(999);
  std::generate(values.begin(), values.end(), [&] { return normal(random); });
  const double mean_before = statistics_of(values).mean;
  for (int i = 0; i < 20; ++i) {
    std::shuffle(values.begin(), values.end(), random);
    EXPECT_EQ(statistics_of(values).mean, mean_before);
  }
}

}  // namespace
}  // namespace zerocount::iso230
