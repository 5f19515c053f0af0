#include "analysis/statistics/clusters/trial_clusters.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/statistics/sums/state.hpp"

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

// Few rigs with many trials, about as many, and rigs without a trial.
INSTANTIATE_TEST_SUITE_P(Rigs, TrialClustersOf, ::testing::Values(1, 7, 64, 699, 5000));

}  // namespace
}  // namespace zerocount::statistics
