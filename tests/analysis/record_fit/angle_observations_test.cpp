// What readings say of the angle: errors as claimed, whatever the encoder's phase, and without favour.
#include "analysis/record_fit/angle_observations.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace zerocount::testing {
namespace {

/// A path of `samples` that wanders up and down by up to `most` counts a sample.
Eigen::VectorXd wandering_path(Eigen::Index samples, double most, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double period = 200.0 * (1.0 + uniform(random));
  const double start = 2.0 * 3.141592653589793 * uniform(random);
  Eigen::VectorXd path(samples);
  double at = uniform(random);
  for (Eigen::Index k = 0; k < samples; ++k) {
    path[k] = at;
    at += most * std::sin(start + static_cast<double>(k) / period);
  }
  return path;
}

Eigen::VectorXd read(const Eigen::VectorXd& path, double noise, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return path.unaryExpr([&](double at) { return std::floor(at + noise * normal(random)); });
}

record_fit::TestRecord counted() {
  record_fit::TestRecord record;
  record.counted = true;
  return record;
}

struct ErrorSums {
  double count{0.0};
  double mean{0.0};      // of error/standard deviation
  double variance{0.0};  // of error/standard deviation
};

/// Over 300 paths of 1000 samples.
ErrorSums errors_of(double most, double noise) {
  std::mt19937_64 random(31);
  ErrorSums sums;
  std::vector<record_fit::AngleObservation> observations;
  for (int round = 0; round < 300; ++round) {
    const Eigen::VectorXd path = wandering_path(1000, most, random);
    record_fit::observe(counted(), path, read(path, noise, random), noise, observations);
    for (const record_fit::AngleObservation& o : observations) {
      const double error = (o.position - record_fit::mean_over(o, path).value()) / std::sqrt(o.variance);
      sums.count += 1.0;
      sums.mean += error;
      sums.variance += error * error;
    }
  }
  sums.mean /= sums.count;
  sums.variance /= sums.count;
  return sums;
}

TEST(AngleObservations, ErrorsHaveNoMeanAndTheVarianceClaimed) {
  for (const double most : {0.05, 0.3, 0.9, 1.5, 6.0}) {
    const ErrorSums sums = errors_of(most, 0.0);
    EXPECT_GT(sums.count, 1000.0);
    EXPECT_NEAR(sums.mean, 0.0, 0.02) << most;
    // Where the rotor is slow, edges are known better than they are taken to be.
    EXPECT_NEAR(sums.variance, most < 0.1 ? 0.77 : 1.0, 0.05) << most;
  }
}

TEST(AngleObservations, EdgesLieBetweenTheSamplesThatSawThemPassed) {
  std::mt19937_64 random(32);
  std::vector<record_fit::AngleObservation> observations;
  for (int round = 0; round < 100; ++round) {
    const Eigen::VectorXd path = wandering_path(500, 0.7, random);
    const Eigen::VectorXd readings = read(path, 0.0, random);
    record_fit::observe(counted(), path, readings, 0.0, observations);
    std::size_t changes = 0;
    for (Eigen::Index k = 1; k < path.size(); ++k) changes += readings[k] != readings[k - 1] ? 1 : 0;
    EXPECT_EQ(observations.size(), changes);
    for (const record_fit::AngleObservation& o : observations) {
      const auto k = static_cast<Eigen::Index>(o.first);
      EXPECT_EQ(o.last, o.first + 1);
      EXPECT_EQ(o.position, std::max(readings[k], readings[k + 1]));
      EXPECT_LE(std::min(path[k], path[k + 1]), o.position);
      EXPECT_GE(std::max(path[k], path[k + 1]), o.position);
    }
  }
}

TEST(AngleObservations, FastReadingsAllCount) {
  std::mt19937_64 random(33);
  Eigen::VectorXd path(50);
  for (Eigen::Index k = 0; k < path.size(); ++k) path[k] = 3.7 * static_cast<double>(k) + 0.1;
  std::vector<record_fit::AngleObservation> observations;
  const Eigen::VectorXd readings = read(path, 0.0, random);
  record_fit::observe(counted(), path, readings, 0.0, observations);
  ASSERT_EQ(observations.size(), 50u);
  for (std::size_t k = 0; k < observations.size(); ++k) {
    EXPECT_EQ(observations[k].first, k);
    EXPECT_EQ(observations[k].last, k);
    EXPECT_EQ(observations[k].position, readings[static_cast<Eigen::Index>(k)] + 0.5);
  }
}

TEST(AngleObservations, WithNoiseAveragesHaveTheVarianceClaimed) {
  for (const double noise : {0.1, 0.3, 1.0}) {
    for (const double most : {0.05, 0.3, 1.5}) {
      const ErrorSums sums = errors_of(most, noise);
      EXPECT_NEAR(sums.mean, 0.0, 0.02) << noise << ", " << most;
      // The variance of an average is a rough formula where the noise is small; weights need no more.
      EXPECT_NEAR(std::sqrt(sums.variance), 1.0, 0.5) << noise << ", " << most;
    }
  }
}

TEST(AngleObservations, ReadingsThatAreNoCountsStandForThemselves) {
  std::vector<record_fit::AngleObservation> observations;
  const Eigen::VectorXd readings = Eigen::VectorXd::LinSpaced(9, 0.3, 4.0);
  record_fit::observe(record_fit::TestRecord{}, readings, readings, 0.2, observations);
  ASSERT_EQ(observations.size(), 9u);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_EQ(observations[k].position, readings[static_cast<Eigen::Index>(k)]);
    EXPECT_DOUBLE_EQ(observations[k].variance, 0.04);
  }
}

/// Mean of the estimates over ten readings of the paths, as a proportion of `noise`.
template <class Path>
double mean_estimate(double noise, const Path& path, std::mt19937_64& random) {
  constexpr int rounds = 10;
  double sum = 0.0;
  for (int round = 0; round < rounds; ++round) {
    const Eigen::VectorXd one = path();
    sum += record_fit::counting_noise(counted(), one, read(one, noise, random));
  }
  return sum / rounds / noise;
}

TEST(CountingNoise, IsFoundFromNeighbours) {
  std::mt19937_64 random(34);
  const auto path = [&] { return wandering_path(20000, 0.1, random); };
  for (const double noise : {0.04, 0.1, 0.3, 1.0, 3.0})
    EXPECT_NEAR(mean_estimate(noise, path, random), 1.0, 0.1) << noise;
}

// Most readings of a fast record have no neighbour within a part of a count.
TEST(CountingNoise, IsFoundAtAnySpeed) {
  std::mt19937_64 random(38);
  std::uniform_real_distribution<double> phase(0.0, 1.0);
  for (const double noise : {0.05, 0.2, 1.0}) {
    for (const double speed : {0.02, 0.31, 0.77, 2.0, 6.0}) {
      const auto path = [&] {
        Eigen::VectorXd at = Eigen::VectorXd::LinSpaced(6000, 0.0, 5999.0);
        return Eigen::VectorXd(phase(random) + speed * (at.array() + 600.0 * (at.array() / 1000.0).sin()));
      };
      EXPECT_NEAR(mean_estimate(noise, path, random), 1.0, noise < 0.1 ? 0.25 : 0.1)
          << noise << " at " << speed;
    }
  }
}

TEST(CountingNoise, IsNoneWhereThereIsNone) {
  std::mt19937_64 random(35);
  std::uniform_real_distribution<double> speed(0.05, 3.0);
  for (int round = 0; round < 200; ++round) {
    const Eigen::VectorXd path = wandering_path(5000, speed(random), random);
    EXPECT_EQ(record_fit::counting_noise(counted(), path, read(path, 0.0, random)), 0.0);
  }
}

TEST(CountingNoise, IsNotWhatTheModelFailsToFollow) {
  std::mt19937_64 random(36);
  const Eigen::VectorXd path = wandering_path(20000, 0.1, random);
  Eigen::VectorXd off = path;
  for (Eigen::Index k = 0; k < off.size(); ++k) off[k] += 5.0 * std::sin(1e-3 * static_cast<double>(k));
  EXPECT_NEAR(record_fit::counting_noise(counted(), off, read(path, 0.1, random)), 0.1, 0.02);
}

// A straight line bridges masked readings. Over a step it is far from the path, and so are its edges.
TEST(CountingNoise, IgnoresTheLinesInPlaceOfMaskedReadings) {
  std::mt19937_64 random(37);
  for (int round = 0; round < 100; ++round) {
    Eigen::VectorXd path = wandering_path(2000, 0.15, random);
    path.tail(1000).array() += 300.0;
    record_fit::TestRecord record = counted();
    record.excluded.assign(2000, false);
    Eigen::VectorXd readings = read(path, 0.0, random);
    const double height = readings[1060] - readings[979];
    for (Eigen::Index k = 980; k < 1060; ++k) {
      record.excluded[static_cast<std::size_t>(k)] = true;
      readings[k] = std::round(readings[979] + height * static_cast<double>(k - 979) / 81.0);
    }
    EXPECT_GT(record_fit::counting_noise(counted(), path, readings), 0.0);
    EXPECT_EQ(record_fit::counting_noise(record, path, readings), 0.0);
  }
}

}  // namespace
}  // namespace zerocount::testing
