#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/record/fit/observations.hpp"
#include "tests/analysis/record/fit/wandering_path.hpp"

namespace zerocount::testing {
namespace {

/// Mean of the estimated encoder noise over ten readings of random paths, as a proportion of the true
/// `noise`.
template <class Path>
double mean_estimate(double noise, const Path& path, std::mt19937_64& random) {
  constexpr int rounds = 10;
  double sum = 0.0;
  for (int round = 0; round < rounds; ++round) {
    const Eigen::VectorXd one = path();
    sum += fit::counting_noise(counted(), one, read(one, noise, random));
  }
  return sum / rounds / noise;
}

TEST(CountingNoise, IsEstimatedFromNeighbouringReadings) {
  std::mt19937_64 random(34);
  const auto path = [&] { return wandering_path(20000, 0.1, random); };
  for (const double noise : {0.04, 0.1, 0.3, 1.0, 3.0})
    EXPECT_NEAR(mean_estimate(noise, path, random), 1.0, 0.1) << noise;
}

// Most readings of a fast record have no neighbour within a part of a count.
TEST(CountingNoise, IsEstimatedAtAnySpeed) {
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

TEST(CountingNoise, IsZeroForNoiselessReadings) {
  std::mt19937_64 random(35);
  std::uniform_real_distribution<double> speed(0.05, 3.0);
  for (int round = 0; round < 200; ++round) {
    const Eigen::VectorXd path = wandering_path(5000, speed(random), random);
    EXPECT_EQ(fit::counting_noise(counted(), path, read(path, 0.0, random)), 0.0);
  }
}

TEST(CountingNoise, ExcludesTheErrorOfTheModel) {
  std::mt19937_64 random(36);
  const Eigen::VectorXd path = wandering_path(20000, 0.1, random);
  Eigen::VectorXd off = path;
  for (Eigen::Index k = 0; k < off.size(); ++k) off[k] += 5.0 * std::sin(1e-3 * static_cast<double>(k));
  EXPECT_NEAR(fit::counting_noise(counted(), off, read(path, 0.1, random)), 0.1, 0.02);
}

// A straight line bridges masked readings. Over a step it is far from the path, and so are its edges.
TEST(CountingNoise, IgnoresMaskedReadings) {
  std::mt19937_64 random(37);
  for (int round = 0; round < 100; ++round) {
    Eigen::VectorXd path = wandering_path(2000, 0.15, random);
    path.tail(1000).array() += 300.0;
    fit::TestRecord record = counted();
    record.excluded.assign(2000, false);
    Eigen::VectorXd readings = read(path, 0.0, random);
    const double height = readings[1060] - readings[979];
    for (Eigen::Index k = 980; k < 1060; ++k) {
      record.excluded[static_cast<std::size_t>(k)] = true;
      readings[k] = std::round(readings[979] + height * static_cast<double>(k - 979) / 81.0);
    }
    EXPECT_GT(fit::counting_noise(counted(), path, readings), 0.0);
    EXPECT_EQ(fit::counting_noise(record, path, readings), 0.0);
  }
}

/// The encoder noise that fit::edge_noise() estimates from two simulated records of one encoder.
/// @param noise true noise, counts
/// @param most largest change of the path per sample, counts
/// @param
///        model_error amplitude of the error of the fitted motion, counts
double edge_noise_of(double noise, double most, double model_error, std::mt19937_64& random) {
  std::vector<fit::TestRecord> records;
  fit::FittedModel model;
  for (int record = 0; record < 2; ++record) {
    Eigen::VectorXd path = wandering_path(3000, most, random);
    const Eigen::VectorXd readings = read(path, noise, random);
    records.push_back(counted());
    records.back().reading.assign(readings.begin(), readings.end());
    for (Eigen::Index k = 0; k < path.size(); ++k)
      path[k] += model_error * std::sin(2e-3 * static_cast<double>(k));
    model.motions.push_back({path, {}});
  }
  return fit::edge_noise(records, model, records.front().unit);
}

TEST(EdgeNoise, IsEstimatedBelowATenthOfACount) {
  std::mt19937_64 random(39);
  for (const double noise : {0.025, 0.03, 0.05}) {
    for (const double most : {0.05, 0.1, 0.2}) {
      double sum = 0.0;
      for (int round = 0; round < 10; ++round) sum += edge_noise_of(noise, most, 0.0, random) / 10.0;
      EXPECT_NEAR(sum / noise, 1.0, 0.4) << noise << " at " << most;
    }
  }
}

TEST(EdgeNoise, IsZeroForNoiselessReadings) {
  std::mt19937_64 random(40);
  std::uniform_real_distribution<double> speed(0.02, 0.5);
  std::uniform_real_distribution<double> error(0.0, 1.0);
  for (int round = 0; round < 100; ++round)
    EXPECT_LT(edge_noise_of(0.0, speed(random), error(random), random), 0.01) << round;
}

}  // namespace
}  // namespace zerocount::testing
