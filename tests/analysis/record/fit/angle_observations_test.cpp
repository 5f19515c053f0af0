// What readings say of the angle: errors as claimed, whatever the encoder's phase, and without favour.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/record/fit/observations.hpp"
#include "tests/analysis/record/fit/wandering_path.hpp"

namespace zerocount::testing {
namespace {

struct ErrorSums {
  double count{0.0};
  double mean{0.0};      // of error/standard deviation
  double variance{0.0};  // of error/standard deviation
};

/// Sums of the errors of the estimated angles over 300 random paths of 1000 samples.
ErrorSums errors_of(double most, double noise) {
  std::mt19937_64 random(31);
  ErrorSums sums;
  std::vector<fit::AngleObservation> observations;
  for (int round = 0; round < 300; ++round) {
    const Eigen::VectorXd path = wandering_path(1000, most, random);
    fit::observe(counted(), path, read(path, noise, random), noise, observations);
    for (const fit::AngleObservation& o : observations) {
      const double error = (o.position - fit::mean_over(o, path).value()) / std::sqrt(o.variance);
      sums.count += 1.0;
      sums.mean += error;
      sums.variance += error * error;
    }
  }
  sums.mean /= sums.count;
  sums.variance /= sums.count;
  return sums;
}

TEST(AngleObservations, ErrorsHaveZeroMeanAndTheClaimedVariance) {
  for (const double most : {0.05, 0.3, 0.9, 1.5, 6.0}) {
    const ErrorSums sums = errors_of(most, 0.0);
    EXPECT_GT(sums.count, 1000.0);
    EXPECT_NEAR(sums.mean, 0.0, 0.02) << most;
    // Where the rotor is slow, edges are known better than they are taken to be.
    EXPECT_NEAR(sums.variance, most < 0.1 ? 0.77 : 1.0, 0.05) << most;
  }
}

TEST(AngleObservations, EdgesLieBetweenTheSamplesAroundThem) {
  std::mt19937_64 random(32);
  std::vector<fit::AngleObservation> observations;
  for (int round = 0; round < 100; ++round) {
    const Eigen::VectorXd path = wandering_path(500, 0.7, random);
    const Eigen::VectorXd readings = read(path, 0.0, random);
    fit::observe(counted(), path, readings, 0.0, observations);
    std::size_t changes = 0;
    for (Eigen::Index k = 1; k < path.size(); ++k) changes += readings[k] != readings[k - 1] ? 1 : 0;
    EXPECT_EQ(observations.size(), changes);
    for (const fit::AngleObservation& o : observations) {
      const auto k = static_cast<Eigen::Index>(o.first);
      EXPECT_EQ(o.last, o.first + 1);
      EXPECT_EQ(o.position, std::max(readings[k], readings[k + 1]));
      EXPECT_LE(std::min(path[k], path[k + 1]), o.position);
      EXPECT_GE(std::max(path[k], path[k + 1]), o.position);
    }
  }
}

TEST(AngleObservations, FastReadingsAreAllUsed) {
  std::mt19937_64 random(33);
  Eigen::VectorXd path(50);
  for (Eigen::Index k = 0; k < path.size(); ++k) path[k] = 3.7 * static_cast<double>(k) + 0.1;
  std::vector<fit::AngleObservation> observations;
  const Eigen::VectorXd readings = read(path, 0.0, random);
  fit::observe(counted(), path, readings, 0.0, observations);
  ASSERT_EQ(observations.size(), 50u);
  for (std::size_t k = 0; k < observations.size(); ++k) {
    EXPECT_EQ(observations[k].first, k);
    EXPECT_EQ(observations[k].last, k);
    EXPECT_EQ(observations[k].position, readings[static_cast<Eigen::Index>(k)] + 0.5);
  }
}

TEST(AngleObservations, AveragesOfNoisyReadingsHaveTheClaimedVariance) {
  for (const double noise : {0.1, 0.3, 1.0}) {
    for (const double most : {0.05, 0.3, 1.5}) {
      const ErrorSums sums = errors_of(most, noise);
      EXPECT_NEAR(sums.mean, 0.0, 0.02) << noise << ", " << most;
      // The variance of an average is a rough formula where the noise is small; weights need no more.
      EXPECT_NEAR(std::sqrt(sums.variance), 1.0, 0.5) << noise << ", " << most;
    }
  }
}

TEST(AngleObservations, UncountedReadingsAreUsedDirectly) {
  std::vector<fit::AngleObservation> observations;
  const Eigen::VectorXd readings = Eigen::VectorXd::LinSpaced(9, 0.3, 4.0);
  fit::observe(fit::TestRecord{}, readings, readings, 0.2, observations);
  ASSERT_EQ(observations.size(), 9u);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_EQ(observations[k].position, readings[static_cast<Eigen::Index>(k)]);
    EXPECT_DOUBLE_EQ(observations[k].variance, 0.04);
  }
}

}  // namespace
}  // namespace zerocount::testing
