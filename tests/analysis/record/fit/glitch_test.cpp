// A single wrong reading is told from the noise of all.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/record/fit/residuals.hpp"

namespace zerocount::testing {
namespace {

struct NoisyRecord {
  fit::TestRecord record;
  Eigen::VectorXd path;
};

/// Encoder readings of a rotor that oscillates by 20 counts, with noise. `noise` is its standard deviation in
/// counts.
NoisyRecord noisy_record(double noise, bool counted, std::mt19937_64& random) {
  constexpr Eigen::Index samples = 20'000;
  std::normal_distribution<double> normal(0.0, 1.0);
  NoisyRecord result;
  result.record.counted = counted;
  result.path.resize(samples);
  for (Eigen::Index k = 0; k < samples; ++k) {
    result.path[k] = 20.0 * std::sin(1e-2 * static_cast<double>(k));
    const double angle = result.path[k] + noise * normal(random);
    result.record.reading.push_back(counted ? std::floor(angle) : angle);
  }
  return result;
}

TEST(Glitch, NoiseIsNotAGlitch) {
  std::mt19937_64 random(1);
  for (int set = 0; set < 40; ++set) {
    const double noise = std::uniform_real_distribution<double>(0.0, 3.0)(random);
    for (const bool counted : {true, false}) {
      const NoisyRecord noisy = noisy_record(noise, counted, random);
      EXPECT_FALSE(fit::find_glitch(noisy.record, noisy.path)) << noise << counted;
    }
  }
}

TEST(Glitch, AReadingFarBeyondTheNoiseIsAGlitch) {
  std::mt19937_64 random(2);
  for (int set = 0; set < 40; ++set) {
    const double noise = std::uniform_real_distribution<double>(0.0, 1.0)(random);
    for (const bool counted : {true, false}) {
      NoisyRecord noisy = noisy_record(noise, counted, random);
      const std::size_t at = std::uniform_int_distribution<std::size_t>(10, 19'900)(random);
      noisy.record.reading[at] += std::ceil(20.0 * noise + 4.0);
      const auto found = fit::find_glitch(noisy.record, noisy.path);
      ASSERT_TRUE(found) << noise << counted;
      EXPECT_EQ(*found, at);
    }
  }
}

// A model that does not fit leaves residuals on smooth flanks, which are no faults of the readings.
TEST(Glitch, AReadingInLineWithItsNeighboursIsNotAGlitch) {
  std::mt19937_64 random(4);
  NoisyRecord exact = noisy_record(0.0, true, random);
  Eigen::VectorXd wrong = exact.path;
  wrong[700] -= 6.0;
  EXPECT_FALSE(fit::find_glitch(exact.record, wrong));
  exact.record.reading[700] += 6.0;
  EXPECT_TRUE(fit::find_glitch(exact.record, exact.path));
}

TEST(Glitch, APoorFitFindsNoGlitch) {
  std::mt19937_64 random(5);
  NoisyRecord exact = noisy_record(0.0, true, random);
  exact.record.reading[700] += 6.0;
  const Eigen::VectorXd wrong =
      exact.path.array() + 2.0 * Eigen::ArrayXd::LinSpaced(exact.path.size(), -1.0, 1.0);
  EXPECT_FALSE(fit::find_glitch(exact.record, wrong));
}

TEST(Glitch, AMaskedReadingIsNotAGlitch) {
  std::mt19937_64 random(3);
  NoisyRecord noisy = noisy_record(0.2, true, random);
  noisy.record.reading[700] += 50.0;
  EXPECT_TRUE(fit::find_glitch(noisy.record, noisy.path));
  noisy.record.excluded.assign(noisy.record.reading.size(), false);
  noisy.record.excluded[700] = true;
  EXPECT_FALSE(fit::find_glitch(noisy.record, noisy.path));
}

}  // namespace
}  // namespace zerocount::testing
