// The extremes of a profile, against a dense scan of it.
#include "core/friction/profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include <gtest/gtest.h>

namespace zerocount::friction {
namespace {

/// A profile of `waves` harmonics with normal coefficients, of which each is 0 with a probability of 1/2, so
/// that no symmetry is common to all.
Profile random_profile(std::mt19937_64& numbers, std::size_t waves) {
  std::normal_distribution<double> normal;
  std::bernoulli_distribution is_there(0.5);
  Profile profile{.marginal = is_there(numbers) ? Marginal::normal : Marginal::lognormal,
                  .location = 1.0,
                  .scale = 0.3,
                  .cosine = {},
                  .sine = {},
                  .period = is_there(numbers) ? 0.25 : 6.283185307179586};
  for (std::size_t m = 0; m <= waves; ++m) {
    profile.cosine.push_back(is_there(numbers) ? normal(numbers) : 0.0);
    profile.sine.push_back(is_there(numbers) ? normal(numbers) : 0.0);
  }
  return profile;
}

TEST(ProfileRange, HasTheExtremesOfADenseScan) {
  std::mt19937_64 numbers(20020721);
  for (int i = 0; i < 200; ++i) {
    const std::size_t waves = 1 + static_cast<std::size_t>(i) % 40;
    const Profile profile = random_profile(numbers, waves);
    const std::size_t count = 400 * (waves + 1);
    double low = value_at(profile, 0.0), high = low;
    for (std::size_t k = 1; k < count; ++k) {
      const double value =
          value_at(profile, profile.period * static_cast<double>(k) / static_cast<double>(count));
      low = std::min(low, value);
      high = std::max(high, value);
    }
    const ValueRange range = range_over_revolution(profile);
    const double tolerance = 5e-3 * (high - low) + 1e-12;  // of the scan, and of nearly equal extremes
    EXPECT_NEAR(range.low, low, tolerance) << waves << " waves, profile " << i;
    EXPECT_NEAR(range.high, high, tolerance) << waves << " waves, profile " << i;
    EXPECT_EQ(lowest_over_revolution(profile), range.low);
  }
}

}  // namespace
}  // namespace zerocount::friction
