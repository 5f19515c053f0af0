#include "analysis/statistics/clusters/trial_clusters.hpp"

#include "analysis/statistics/sums/state.hpp"
#include "analysis/statistics/unknown.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

constexpr std::int64_t moves = 3;

/// The values of a trial that are not censored: few distinct ones.
std::vector<double> values_of(std::int64_t trial) {
  std::mt19937_64 random(static_cast<std::uint64_t>(trial));
  std::vector<double> values;
  for (std::int64_t move = 0; move < moves; ++move) {
    if (random() % 5 != 0) values.push_back(static_cast<double>(random() % 20));
  }
  return values;
}

TrialClusters clusters_of(std::int64_t rigs, std::int64_t first, std::int64_t end) {
  TrialClusters clusters(rigs);
  for (std::int64_t trial = first; trial < end; ++trial) {
    std::vector<double> values = values_of(trial);
    clusters.add_trial(trial, values, moves);
  }
  return clusters;
}

State state_of(const TrialClusters& clusters) {
  State state;
  StateWriter writer(state);
  writer(clusters);
  return state;
}

class TrialClustersOf : public ::testing::TestWithParam<std::int64_t> {};

TEST_P(TrialClustersOf, MomentsAreThoseOfTheValuesOfEachRig) {
  const std::int64_t rigs = GetParam();
  constexpr std::int64_t trials = 700;
  std::vector<std::vector<double>> by_rig(static_cast<std::size_t>(rigs));
  for (std::int64_t trial = 0; trial < trials; ++trial) {
    const std::vector<double> values = values_of(trial);
    std::vector<double>& rig = by_rig[static_cast<std::size_t>(trial % rigs)];
    rig.insert(rig.end(), values.begin(), values.end());
  }
  const ClusteredSample sample = clusters_of(rigs, 0, trials).sample();
  EXPECT_EQ(sample.size(), moves * trials);
  for (const double x : {-1.0, 4.0, 11.5, 30.0}) {
    ClusterSums expected;
    for (std::int64_t rig = 0; rig < rigs; ++rig) {
      const std::vector<double>& values = by_rig[static_cast<std::size_t>(rig)];
      const auto hits = std::count_if(values.begin(), values.end(), [&](double value) { return value <= x; });
      expected.add(hits, moves * ((trials - rig + rigs - 1) / rigs));
    }
    const ClusterSums found = sample.at_most(x);
    EXPECT_EQ(found.clusters, std::min(rigs, trials));
    EXPECT_EQ(found.hits, expected.hits);
    EXPECT_EQ(found.events, moves * trials);
    EXPECT_EQ(found.hits_squared, expected.hits_squared);
    EXPECT_EQ(found.hits_by_events, expected.hits_by_events);
    EXPECT_EQ(found.events_squared, expected.events_squared);
  }
}

TEST_P(TrialClustersOf, BlocksInAnyOrderGiveTheStateOfAllTrials) {
  const std::int64_t rigs = GetParam();
  constexpr std::int64_t trials = 700;
  const State whole = state_of(clusters_of(rigs, 0, trials));
  std::mt19937_64 random(7);
  for (int order = 0; order < 20; ++order) {
    std::vector<TrialClusters> blocks;
    for (std::int64_t first = 0; first < trials;) {
      const std::int64_t end =
          std::min<std::int64_t>(trials, first + 1 + static_cast<std::int64_t>(random() % 90));
      blocks.push_back(clusters_of(rigs, first, end));
      first = end;
    }
    std::shuffle(blocks.begin(), blocks.end(), random);
    TrialClusters sum(rigs);
    for (const TrialClusters& block : blocks) sum += block;
    const State state = state_of(sum);
    EXPECT_EQ(state.whole, whole.whole);
    EXPECT_EQ(state.real, whole.real);
    TrialClusters again(rigs);
    StateReader reader(state.whole, state.real);
    reader(again);
    reader.require_end();
    again += clusters_of(rigs, trials, trials + 50);
    EXPECT_EQ(state_of(again).whole, state_of(clusters_of(rigs, 0, trials + 50)).whole);
  }
}

TEST(TrialClusters, OfAColumnAreThoseOfItsTrials) {
  std::mt19937_64 random(9);
  for (const std::int64_t rigs : {0, 0, 7}) {
    TrialClusters one_by_one(rigs), by_column(rigs);
    for (std::int64_t trial = 0; trial < 3000;) {
      // Single values before and after trials of several; columns of repeated and of different values.
      const std::size_t of_trial = random() % 4 == 0 ? 1 + random() % 3 : 1;
      const bool nan_is_late = random() % 2 == 0;
      const std::uint64_t distinct = random() % 2 == 0 ? 20 : 1'000'000;
      const auto trials = static_cast<std::int64_t>(1 + random() % 400);
      std::vector<double> column;
      for (std::int64_t i = 0; i < trials; ++i) {
        std::vector<double> observed;
        for (std::size_t j = 0; j < of_trial; ++j) {
          column.push_back(random() % 5 == 0 ? unknown : static_cast<double>(random() % distinct));
          if (column.back() == column.back()) observed.push_back(column.back());
        }
        const auto size = static_cast<std::int64_t>(nan_is_late ? of_trial : observed.size());
        one_by_one.add_trial(trial + i, observed, size);
      }
      by_column.add_trials(trial, column, of_trial, nan_is_late);
      trial += trials;
      EXPECT_EQ(by_column.size(), one_by_one.size());
    }
    EXPECT_EQ(state_of(by_column).whole, state_of(one_by_one).whole);
    EXPECT_EQ(state_of(by_column).real, state_of(one_by_one).real);
  }
}

// Few rigs with many trials, about as many, and rigs without a trial.
INSTANTIATE_TEST_SUITE_P(Rigs, TrialClustersOf, ::testing::Values(1, 7, 64, 699, 5000));

}  // namespace
}  // namespace zerocount::statistics
