#include "analysis/jerks/clustered_share.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/failure.hpp"

namespace zerocount {
namespace {

TEST(ClusteredShare, OfEventsThatComeAloneIsClopperPearsons) {
  for (const std::int64_t hits : {1, 7, 30}) {
    ClusterSums sums;
    for (int i = 0; i < 40; ++i) sums.add(i < hits, 1);
    const ClusteredShare share = sums.share();
    const ConfidenceInterval expected = clopper_pearson(hits, 40);
    EXPECT_EQ(share.share, static_cast<double>(hits) / 40.0);
    // m/(m − 1) makes 39 of the 40.
    EXPECT_NEAR(share.independent, 39.0, 1e-9);
    EXPECT_NEAR(share.bounds.low, expected.low, 0.01);
    EXPECT_NEAR(share.bounds.high, expected.high, 0.01);
  }
}

TEST(ClusteredShare, EventsThatAreAlikeInTheirClusterCountOnce) {
  ClusterSums sums;
  for (int i = 0; i < 50; ++i) sums.add(i < 20 ? 6 : 0, 6);
  EXPECT_NEAR(sums.share().independent, 49.0, 1e-9);
  ClusterSums all;
  for (int i = 0; i < 50; ++i) all.add(6, 6);
  EXPECT_EQ(all.share().independent, 50.0);
  EXPECT_EQ(all.share().bounds.high, 1.0);
  EXPECT_NEAR(all.share().bounds.low, clopper_pearson(50, 50).low, 1e-12);
}

TEST(ClusteredShare, AClusterWithManyEventsDoesNotDecideAlone) {
  ClusterSums sums;
  sums.add(1000, 1000);
  for (int i = 0; i < 9; ++i) sums.add(1, 1);
  EXPECT_LT(sums.share().independent, 1.02);  // n²/Σnᵢ²
}

TEST(ClusteredShare, WithoutAnEventNothingIsKnown) {
  ClusterSums sums;
  sums.add(0, 0);
  const ClusteredShare share = sums.share();
  EXPECT_TRUE(std::isnan(share.share));
  EXPECT_EQ(share.bounds.low, 0.0);
  EXPECT_EQ(share.bounds.high, 1.0);
  EXPECT_THROW(sums.share(0.0), Failure);
}

TEST(ClusteredShare, BoundsCoverTheShareWhereTrialsDiffer) {
  std::mt19937_64 random(101);
  std::uniform_real_distribution<double> uniform;
  std::uniform_int_distribution<int> size(1, 12);
  constexpr int rounds = 3000;
  int covered = 0, plainly = 0;
  for (int round = 0; round < rounds; ++round) {
    ClusterSums sums;
    for (int cluster = 0; cluster < 60; ++cluster) {
      const double of_cluster = std::sqrt(uniform(random));  // mean 2/3
      const int events = size(random);
      std::binomial_distribution<int> hits(events, of_cluster);
      sums.add(hits(random), events);
    }
    const ClusteredShare share = sums.share();
    covered += share.bounds.low <= 2.0 / 3.0 && 2.0 / 3.0 <= share.bounds.high;
    const ConfidenceInterval plain = clopper_pearson(share.hits, share.events);
    plainly += plain.low <= 2.0 / 3.0 && 2.0 / 3.0 <= plain.high;
  }
  EXPECT_GE(covered, 0.94 * rounds);
  EXPECT_LE(covered, 0.98 * rounds);
  EXPECT_LT(plainly, 0.9 * rounds);  // as if the events of a trial were independent: too narrow
}

}  // namespace
}  // namespace zerocount
