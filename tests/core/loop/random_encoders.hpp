#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/loop/measurement.hpp"

namespace zerocount::testing {

inline constexpr double revolution = 2.0 * std::numbers::pi;

inline random::TrialRandomness randomness_of_encoders(std::uint64_t trial) {
  random::TrialRandomness randomness;
  randomness.trial = trial;
  randomness.fine_noise = {1, 2};
  randomness.fine_missed = {3, 4};
  randomness.coarse_noise = {5, 6};
  randomness.coarse_missed = {7, 8};
  return randomness;
}

/// Tests with encoders and angles drawn by the seed that is their parameter.
class WithRandomEncoders : public ::testing::TestWithParam<unsigned> {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  /// Coarser, finer or equal, their counts commensurate or not.
  loop::EncoderParameters random_encoders() {
    loop::EncoderParameters encoders;
    encoders.coarse = std::floor(std::pow(10.0, uniform(1.0, 5.0)));
    encoders.fine = random_() % 4 == 0 ? encoders.coarse * static_cast<double>(1 + random_() % 20)
                                       : std::floor(std::pow(10.0, uniform(1.0, 6.5)));
    return encoders;
  }

  double random_phase() { return random_() % 4 == 0 ? 0.0 : uniform(0.0, 1.0); }

  std::mt19937 random_{GetParam()};
};

}  // namespace zerocount::testing
