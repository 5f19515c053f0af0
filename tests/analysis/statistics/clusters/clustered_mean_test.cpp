#include "analysis/statistics/clusters/clustered_mean.hpp"

#include <boost/math/distributions/students_t.hpp>

#include "analysis/statistics/mean_bounds.hpp"
#include "analysis/statistics/quantile.hpp"
#include "core/failure/failure.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

constexpr random::RandomStream stream{{12, 34}, 5};

ClusterTotals totals_of(const std::vector<double>& values) {
  ClusterTotals totals;
  for (std::size_t i = 0; i < values.size(); ++i)
    totals.add(static_cast<std::int64_t>(i), std::span(&values[i], 1));
  return totals;
}

Moments moments_of(const std::vector<double>& values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

TEST(ClusteredMean, OfNormalValuesIsAboutStudents) {
  std::mt19937_64 random(51);
  std::normal_distribution<double> normal(3.0, 0.5);
  for (int round = 0; round < 10; ++round) {
    std::vector<double> values(150);
    for (double& value : values) value = normal(random);
    const ConfidenceInterval expected = student_t(moments_of(values));
    const ConfidenceInterval found = clustered_mean_bounds(totals_of(values), stream);
    EXPECT_LE(found.low, expected.low * (1.0 + 1e-12));  // the outer of both
    EXPECT_GE(found.high, expected.high * (1.0 - 1e-12));
    EXPECT_NEAR(found.low, expected.low, 0.25 * (expected.high - expected.low));
    EXPECT_NEAR(found.high, expected.high, 0.25 * (expected.high - expected.low));
  }
}

TEST(ClusteredMean, BootstrapReachesFurtherTowardsTheLongTail) {
  std::mt19937_64 random(52);
  std::exponential_distribution<double> exponential;
  std::vector<double> values(60);
  for (double& value : values) value = exponential(random);
  const double mean = moments_of(values).mean;
  const ConfidenceInterval bounds = clustered_mean_bounds(totals_of(values), stream);
  EXPECT_GT(bounds.high - mean, 1.1 * (mean - bounds.low));
}

TEST(ClusteredMean, ValuesThatAreAlikeInTheirClusterCountOnce) {
  std::mt19937_64 random(53);
  std::gamma_distribution<double> gamma(3.0);
  std::vector<double> values(80);
  for (double& value : values) value = gamma(random);
  ClusterTotals tens;
  for (std::size_t i = 0; i < values.size(); ++i)
    tens.add(static_cast<std::int64_t>(i), std::vector<double>(10, values[i]));
  const ConfidenceInterval single = clustered_mean_bounds(totals_of(values), stream);
  const ConfidenceInterval alike = clustered_mean_bounds(tens, stream);
  EXPECT_NEAR(alike.low, single.low, 1e-12);
  EXPECT_NEAR(alike.high, single.high, 1e-12);
}

TEST(ClusteredMean, ManyClustersAreGatheredIntoGroupsWithoutLoss) {
  std::mt19937_64 random(54);
  std::exponential_distribution<double> exponential;
  std::vector<double> values(100'000);
  for (double& value : values) value = exponential(random);
  const ClusterTotals totals = totals_of(values);
  EXPECT_EQ(totals.sums.end(), max_clusters);
  EXPECT_EQ(totals.clusters(), 100'000);
  const ConfidenceInterval expected = student_t(moments_of(values));
  const ConfidenceInterval found = clustered_mean_bounds(totals, stream);
  EXPECT_NEAR(found.low, expected.low, 0.1 * (expected.high - expected.low));
  EXPECT_NEAR(found.high, expected.high, 0.1 * (expected.high - expected.low));
}

TEST(ClusteredMean, ResamplesDependOnTheirStreamAlone) {
  const ClusterTotals totals = totals_of({1.0, 2.0, 4.0, 8.0, 16.0, 3.0, 2.5, 7.0});
  const ConfidenceInterval once = clustered_mean_bounds(totals, stream);
  EXPECT_EQ(clustered_mean_bounds(totals, stream).high, once.high);
  EXPECT_NE(clustered_mean_bounds(totals, {{12, 34}, 6}).high, once.high);
}

/// Quantiles of (θ* − θ)/e* of the mm equally probable draws of m clusters, one by one.
std::pair<double, double> tails_of_every_draw(const std::vector<double>& values, double tail) {
  const std::size_t m = values.size();
  const double mean = moments_of(values).mean;
  std::vector<double> studentised;
  const auto draws = static_cast<std::size_t>(std::llround(std::pow(m, m)));
  for (std::size_t draw = 0; draw < draws; ++draw) {
    Moments drawn;
    for (std::size_t i = 0, rest = draw; i < m; ++i, rest /= m) drawn.add(values[rest % m]);
    const double error = drawn.sd() / std::sqrt(static_cast<double>(m));
    const double difference = drawn.mean - mean;
    studentised.push_back(error > 1e-9 ? difference / error
                                       : std::copysign(std::numeric_limits<double>::infinity(), difference));
  }
  return {sample_quantile(studentised, tail), sample_quantile(studentised, 1.0 - tail)};
}

TEST(ClusteredMean, OfFewClustersIsThatOfEverySample) {
  std::mt19937_64 random(55);
  std::exponential_distribution<double> exponential;
  for (const std::size_t m : {2UL, 3UL, 4UL, 5UL, 6UL, 7UL}) {
    std::vector<double> values(m);
    for (double& value : values) value = exponential(random);
    for (const double confidence : {0.5, 0.8, 0.95}) {
      const double tail = 0.5 * (1.0 - confidence);
      const auto [low, high] = tails_of_every_draw(values, tail);
      const Moments moments = moments_of(values);
      const double error = moments.sd() / std::sqrt(static_cast<double>(m));
      const double t = boost::math::quantile(
          boost::math::students_t_distribution<double>(static_cast<double>(m) - 1.0), 1.0 - tail);
      const ConfidenceInterval found = clustered_mean_bounds(totals_of(values), stream, confidence);
      const auto expect = [&](double bound, double quantile) {
        if (std::isinf(quantile)) {
          EXPECT_TRUE(std::isnan(bound)) << m << " clusters, " << confidence;
        } else {
          EXPECT_NEAR(bound, moments.mean - quantile * error, 1e-9) << m << " clusters, " << confidence;
        }
      };
      expect(found.low, std::max(t, high));
      expect(found.high, std::min(-t, low));
      EXPECT_TRUE(clustered_mean_bounds(totals_of(values), {{1, 2}, 3}, confidence).low == found.low ||
                  std::isnan(found.low));
    }
  }
}

TEST(ClusteredMean, SaysNothingWhereThereIsNothingToResample) {
  for (const std::vector<double>& values : {std::vector<double>{}, {1.0}, {0.3, 0.3, 0.3}}) {
    const ConfidenceInterval bounds = clustered_mean_bounds(totals_of(values), stream);
    EXPECT_TRUE(std::isnan(bounds.low));
    EXPECT_TRUE(std::isnan(bounds.high));
  }
  EXPECT_THROW(clustered_mean_bounds(totals_of({1.0, 2.0}), stream, 1.0), Failure);
}

TEST(ClusteredCount, WithoutAnEventHasTheBoundOfOneEventPerCluster) {
  EXPECT_EQ(clustered_count_bounds(totals_of(std::vector<double>(300, 0.0)), stream).low, 0.0);
  EXPECT_NEAR(clustered_count_bounds(totals_of(std::vector<double>(300, 0.0)), stream).high,
              -std::log(0.025) / 300.0, 1e-12);
  EXPECT_NEAR(clustered_count_bounds(totals_of(std::vector<double>(9000, 0.0)), stream).high,
              -std::log(0.025) / 9000.0, 1e-12);  // also of more trials than groups
  ClusterTotals rigs;                             // 100 rigs of 30 trials are worth 100 trials
  for (std::int64_t trial = 0; trial < 3000; ++trial) rigs.add(trial % 100, std::vector<double>{0.0});
  EXPECT_NEAR(clustered_count_bounds(rigs, stream).high, -std::log(0.025) / 100.0, 1e-12);
}

TEST(ClusteredCount, OfFewEventsIsGarwoodsWithStudentsFactor) {
  std::vector<double> values(400, 0.0);
  for (std::size_t i = 0; i < 5; ++i) values[10 * i] = 1.0;
  const boost::math::students_t_distribution<double> student(399.0);
  const double factor = std::pow(1.959963984540054 / boost::math::quantile(student, 0.975), 2);
  const ConfidenceInterval expected = poisson_bounds(5.0 * factor);
  const ConfidenceInterval found = clustered_count_bounds(totals_of(values), stream);
  EXPECT_NEAR(found.low, expected.low / factor / 400.0, 1e-9);
  EXPECT_NEAR(found.high, expected.high / factor / 400.0, 1e-9);
  values[0] = 5.0;  // five at once are worth less than five apart
  const ConfidenceInterval uneven = clustered_count_bounds(totals_of(values), stream);
  EXPECT_GT(uneven.high - uneven.low, 1.3 * (found.high - found.low));
}

}  // namespace
}  // namespace zerocount::statistics
