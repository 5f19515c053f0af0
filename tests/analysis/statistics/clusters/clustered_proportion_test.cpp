#include "analysis/statistics/clusters/clustered_proportion.hpp"

#include "core/failure/failure.hpp"
#include "results/reading/csv.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

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

// Machines that always fail may be among the others unseen, whatever the others do.
TEST(ClusteredProportion, MissesNeverRaiseTheLowerBoundAndHitsNeverLowerTheUpperOne) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 2000; ++round) {
    const auto clusters = static_cast<std::int64_t>(2 + random() % 200);
    const auto size = static_cast<std::int64_t>(1 + random() % 50);
    const double miss = std::pow(10.0, -3.0 * std::uniform_real_distribution<double>()(random));
    std::binomial_distribution<std::int64_t> misses(size, miss);
    ClusterSums some, none, misses_only;
    for (std::int64_t i = 0; i < clusters; ++i) {
      const std::int64_t missed = misses(random);
      some.add(size - missed, size);
      misses_only.add(missed, size);
      none.add(size, size);
    }
    for (const double confidence : {0.5, 0.9, 0.95, 0.999}) {
      const double shown = std::pow(1.0 - confidence, 1.0 / static_cast<double>(clusters));
      EXPECT_NEAR(clustered_at_least(none, confidence), shown, 1e-12);
      EXPECT_LE(clustered_at_least(some, confidence), shown + 1e-12) << clusters << " of " << size;
      EXPECT_NEAR(clustered_at_most(misses_only, confidence), 1.0 - clustered_at_least(some, confidence),
                  1e-9);
    }
    const ClusteredProportion two_sided = clustered_proportion(some);
    const double shown = std::pow(0.025, 1.0 / static_cast<double>(clusters));
    EXPECT_LE(two_sided.korn_graubard.low, shown + 1e-12);
    if (size > 1) {
      EXPECT_LE(two_sided.wilson.low, shown + 1e-12);
    }
  }
}

/// Clusters of so many events, of which the proportion `weak` hits with `weak_rate`, the others with
/// `others_rate`.
struct Mixture {
  std::int64_t clusters;
  std::int64_t size;
  double weak;
  double weak_rate;
  double others_rate{1.0};
};

/// How often the lower bound of the hits of all clusters is not above the truth.
double coverage_of(const Mixture& mixture, int studies) {
  std::mt19937_64 random(11);
  std::binomial_distribution<std::int64_t> number_of_weak(mixture.clusters, mixture.weak);
  std::binomial_distribution<std::int64_t> hits_of_weak(mixture.size, mixture.weak_rate);
  std::binomial_distribution<std::int64_t> hits_of_others(mixture.size, mixture.others_rate);
  const double truth = mixture.weak * mixture.weak_rate + (1.0 - mixture.weak) * mixture.others_rate;
  int covered = 0;
  for (int study = 0; study < studies; ++study) {
    const std::int64_t weak = number_of_weak(random);
    ClusterSums sums;
    for (std::int64_t i = 0; i < mixture.clusters; ++i)
      sums.add(i < weak ? hits_of_weak(random) : hits_of_others(random), mixture.size);
    covered += clustered_at_least(sums, 0.95) <= truth;
  }
  return static_cast<double>(covered) / studies;
}

TEST(ClusteredProportion, LowerBoundsHoldWhereAFewClustersAlwaysOrHalfFail) {
  constexpr int studies = 400;
  const double lowest = 0.95 - 4.0 * std::sqrt(0.95 * 0.05 / studies);
  for (const std::int64_t clusters : {5, 10, 25, 59, 100, 300, 1000}) {
    for (const std::int64_t size : {2, 20}) {
      const auto m = static_cast<double>(clusters);
      for (const double weak : {0.5 / m, 1.0 / m, 2.0 / m, 3.0 / m, 0.3}) {
        for (const double weak_rate : {0.0, 0.5})
          EXPECT_GE(coverage_of({clusters, size, weak, weak_rate}, studies), lowest)
              << clusters << " of " << size << ", weak " << weak << " at " << weak_rate;
      }
    }
  }
}

// Prints the table of analysis/statistics/coverage.md.
TEST(ClusteredProportion, DISABLED_CoversMixtures) {
  constexpr int studies = 4000;
  for (const double others : {1.0, 0.999, 0.99, 0.9}) {
    for (const double weak_rate : {0.0, 0.5}) {
      std::string row = fmt::format("| {} | {} |", others, weak_rate);
      for (const std::int64_t clusters : {10, 25, 100, 300, 1000}) {
        double lowest = 1.0;
        for (const double weak : {0.5, 1.0, 2.0, 3.0})
          lowest = std::min(
              lowest,
              coverage_of({clusters, 20, weak / static_cast<double>(clusters), weak_rate, others}, studies));
        row += fmt::format(" {:.1f} |", 100.0 * lowest);
      }
      fmt::print("{}\n", row);
    }
  }
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
