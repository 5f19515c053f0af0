#include "analysis/statistics/clusters/clustered_proportion.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "results/reading/csv.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::statistics {
namespace {

TEST(ClusteredProportion, OfEventsThatComeAloneIsClopperPearsons) {
  for (const std::int64_t hits : {0, 1, 7, 30, 40}) {
    ClusterSums sums;
    for (int i = 0; i < 40; ++i) sums.add(i < hits, 1);
    const ClusteredProportion found = clustered_proportion(sums);
    EXPECT_EQ(found.value, static_cast<double>(hits) / 40.0);
    EXPECT_EQ(found.effective_events, 40.0);
    EXPECT_NEAR(found.korn_graubard.low, clopper_pearson(hits, 40).low, 1e-12);
    EXPECT_NEAR(found.korn_graubard.high, clopper_pearson(hits, 40).high, 1e-12);
    EXPECT_NEAR(found.wilson.low, wilson(hits, 40).low, 1e-12);
    EXPECT_NEAR(found.wilson.high, wilson(hits, 40).high, 1e-12);
    EXPECT_NEAR(clustered_at_least(sums, 0.9), proportion_at_least(hits, 40, 0.9), 1e-12);
    EXPECT_NEAR(clustered_at_most(sums, 0.9), proportion_at_most(hits, 40, 0.9), 1e-12);
  }
}

TEST(ClusteredProportion, EventsThatAreAlikeInTheirClusterCountOnce) {
  ClusterSums sums;
  for (int i = 0; i < 50; ++i) sums.add(i < 20 ? 6 : 0, 6);
  EXPECT_NEAR(effective_events(sums), 49.0, 1e-9);  // m/(m − 1) makes 49 of the 50
  ClusterSums all;
  for (int i = 0; i < 50; ++i) all.add(6, 6);
  EXPECT_EQ(effective_events(all), 50.0);
  EXPECT_EQ(clustered_proportion(all).korn_graubard.high, 1.0);
  EXPECT_NEAR(clustered_proportion(all).korn_graubard.low, clopper_pearson(50, 50).low, 1e-12);
}

TEST(ClusteredProportion, EventsThatDifferLessThanChanceCountNoMoreThanOnceEach) {
  ClusterSums sums;
  for (int i = 0; i < 50; ++i) sums.add(5, 10);
  EXPECT_EQ(effective_events(sums), 500.0);
}

TEST(ClusteredProportion, AClusterWithManyEventsDoesNotDecideAlone) {
  ClusterSums sums;
  sums.add(1000, 1000);
  for (int i = 0; i < 9; ++i) sums.add(1, 1);
  EXPECT_LT(effective_events(sums), 1.02);  // n²/Σnᵢ²
}

TEST(ClusteredProportion, WithoutAnEventNothingIsKnown) {
  ClusterSums sums;
  sums.add(0, 0);
  const ClusteredProportion found = clustered_proportion(sums);
  EXPECT_TRUE(std::isnan(found.value));
  EXPECT_EQ(found.korn_graubard.low, 0.0);
  EXPECT_EQ(found.korn_graubard.high, 1.0);
  EXPECT_THROW(clustered_proportion(sums, 0.0), Failure);
}

TEST(ClusteredProportion, BoundsAreThoseOfTheFormulaByScipy) {
  const testing::TemporaryFolder folder;
  std::ofstream cases(folder /
                      "cases");  // confidence low high wilson_low wilson_high at_least  k1 n1 k2 n2 …
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> uniform;
  constexpr int rounds = 60;
  for (int round = 0; round < rounds; ++round) {
    const double confidence = round % 3 == 0 ? 0.8 : 0.95;
    ClusterSums sums;
    std::string clusters;
    const int size = 1 + static_cast<int>(random() % 30);
    for (int cluster = 0; cluster < 2 + round; ++cluster) {
      std::binomial_distribution<int> binomial(size, round % 7 == 0 ? 1.0 : std::sqrt(uniform(random)));
      const int hits = binomial(random);
      sums.add(hits, size);
      clusters += fmt::format(" {} {}", hits, size);
    }
    const ClusteredProportion found = clustered_proportion(sums, confidence);
    for (const double value : {confidence, found.korn_graubard.low, found.korn_graubard.high,
                               found.wilson.low, found.wilson.high, clustered_at_least(sums, confidence)}) {
      cases << reading::number_text(value) << " ";
    }
    cases << clusters << "\n";
  }
  cases.close();
  const std::string command =
      fmt::format("{} {} proportions {} > {} 2>&1", ZEROCOUNT_PYTHON, ZEROCOUNT_STATISTICS_JUDGE,
                  (folder / "cases").string(), (folder / "out").string());
  EXPECT_EQ(std::system(command.c_str()), 0) << folder.read("out");
  EXPECT_EQ(folder.read("out"), fmt::format("{} samples\n", rounds));
}

}  // namespace
}  // namespace zerocount::statistics
