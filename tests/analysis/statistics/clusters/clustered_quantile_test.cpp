#include "analysis/statistics/clusters/clustered_quantile.hpp"

#include "analysis/statistics/clusters/tolerance.hpp"
#include "results/reading/csv.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

ClusteredSample sample_of(const std::vector<std::vector<double>>& clusters, std::int64_t size) {
  ClusteredSample sample;
  for (std::vector<double> values : clusters) sample.add_cluster(std::span<double>(values), size);
  return sample;
}

TEST(ClusteredQuantile, OfSingleValuesIsThatOfIndependentOnes) {
  std::mt19937_64 random(41);
  Histogram<double> plain;
  ClusteredSample single;
  for (int i = 0; i < 300; ++i) {
    std::vector<double> value{static_cast<double>(random() % 100)};
    plain.add(value.front());
    single.add_cluster(std::span<double>(value), 1);
  }
  for (const double p : {0.05, 0.5, 0.95}) {
    const Quantile expected = quantile(plain, p);
    const Quantile found = clustered_quantile(single, p);
    EXPECT_EQ(found.value, expected.value);
    EXPECT_EQ(found.low, expected.low);
    EXPECT_EQ(found.high, expected.high);
  }
  EXPECT_EQ(clustered_upper_limit(single, 0.9, 0.95), order_statistic(plain, tolerance_rank(300, 0.9, 0.95)));
}

TEST(ClusteredQuantile, AMoveThatNeverArrivedIsLaterThanAnyTime) {
  std::vector<std::vector<double>> clusters;
  for (int i = 0; i < 100; ++i)
    clusters.push_back(i < 60 ? std::vector<double>{static_cast<double>(i)} : std::vector<double>{});
  const ClusteredSample sample = sample_of(clusters, 1);
  EXPECT_EQ(sample.size(), 100);
  EXPECT_EQ(clustered_quantile(sample, 0.5).value, 49.0);  // of all 100, not of the 60 that arrived
  EXPECT_EQ(clustered_quantile(sample, 0.5).low, 39.0);
  EXPECT_TRUE(std::isnan(clustered_quantile(sample, 0.5).high));  // rank 61 of 60
  EXPECT_TRUE(std::isnan(clustered_quantile(sample, 0.75).value));
  EXPECT_EQ(clustered_quantile(sample, 0.65).low, 55.0);  // though the quantile itself is not reached
  EXPECT_TRUE(std::isnan(clustered_quantile(sample, 0.65).value));
  EXPECT_TRUE(std::isnan(clustered_upper_limit(sample, 0.6, 0.95)));
  const ClusteredSample none = sample_of({{}, {}}, 3);
  EXPECT_TRUE(std::isnan(clustered_quantile(none, 0.5).value));
  EXPECT_TRUE(std::isnan(clustered_quantile(none, 0.5).low));
  EXPECT_TRUE(std::isnan(clustered_quantile(ClusteredSample{}, 0.5).value));
}

TEST(ClusteredQuantile, ValuesThatAreAlikeInTheirClusterCountOnce) {
  ClusteredSample clusters, single;
  for (int i = 0; i < 200; ++i) {
    std::vector<double> ten(10, static_cast<double>(i)), one(1, static_cast<double>(i));
    clusters.add_cluster(std::span<double>(ten), 10);
    single.add_cluster(std::span<double>(one), 1);
  }
  for (const double p : {0.25, 0.5, 0.95}) {
    const Quantile of_clusters = clustered_quantile(clusters, p);
    const Quantile of_single = clustered_quantile(single, p);
    EXPECT_EQ(of_clusters.value, of_single.value);
    EXPECT_NEAR(of_clusters.low, of_single.low, 2.0);  // 199 for 200, and t for the normal distribution
    EXPECT_NEAR(of_clusters.high, of_single.high, 2.0);
    EXPECT_LE(of_clusters.low, of_single.low);
  }
}

TEST(ClusteredQuantile, ClustersMayHaveOneValueOrSeveral) {
  std::vector<double> one{3.0}, none, three{5.0, 3.0, 1.0};
  ClusteredSample sample;
  sample.add_cluster(std::span<double>(one), 1);
  sample.add_cluster(std::span<double>(none), 1);
  sample.add_cluster(std::span<double>(three), 4);
  sample.add_cluster(std::span<double>(one), 1);
  ClusterSums expected;
  for (const auto& [hits, events] : {std::pair{1, 1}, {0, 1}, {2, 4}, {1, 1}}) expected.add(hits, events);
  const ClusterSums found = sample.at_most(3.5);
  EXPECT_EQ(found.hits, expected.hits);
  EXPECT_EQ(found.hits_squared, expected.hits_squared);
  EXPECT_EQ(found.hits_by_events, expected.hits_by_events);
  EXPECT_EQ(found.events_squared, expected.events_squared);
}

TEST(ClusteredQuantile, BoundsAreThoseOfTheFormulaByScipy) {
  const testing::TemporaryFolder folder;
  std::ofstream cases(folder / "cases");  // probability size value low high  x11 … x1size x21 … (nan: never)
  std::mt19937_64 random(43);
  std::normal_distribution<double> normal;
  constexpr int rounds = 60;
  for (int round = 0; round < rounds; ++round) {
    const int size = 1 + static_cast<int>(random() % 6);
    ClusteredSample sample;
    std::string texts;
    for (int cluster = 0; cluster < 20 + 2 * round; ++cluster) {
      const double centre = 3.0 * normal(random);
      std::vector<double> values;
      for (int i = 0; i < size; ++i) {
        const double value = std::round(10.0 * (centre + normal(random)));
        if (value < 40.0) values.push_back(value);
        texts += value < 40.0 ? " " + reading::number_text(value) : " nan";
      }
      sample.add_cluster(std::span<double>(values), size);
    }
    const double p = std::vector<double>{0.05, 0.5, 0.75, 0.9, 0.95}[static_cast<std::size_t>(round) % 5];
    const Quantile found = clustered_quantile(sample, p);
    cases << p << " " << size;
    for (const double value : {found.value, found.low, found.high})
      cases << " " << reading::number_text(value);
    cases << texts << "\n";
  }
  cases.close();
  const std::string command =
      fmt::format("{} {} quantiles {} > {} 2>&1", ZEROCOUNT_PYTHON, ZEROCOUNT_STATISTICS_JUDGE,
                  (folder / "cases").string(), (folder / "out").string());
  EXPECT_EQ(std::system(command.c_str()), 0) << folder.read("out");
  EXPECT_EQ(folder.read("out"), fmt::format("{} samples\n", rounds));
}

}  // namespace
}  // namespace zerocount::statistics
