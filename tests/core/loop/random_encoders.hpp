#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "core/loop/measurement.hpp"
#include "tests/support/each_seed.hpp"

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

/// Tests with encoders and angles drawn by a seed.
struct WithRandomEncoders {
  static constexpr unsigned seeds = 12;
  explicit WithRandomEncoders(unsigned seed) : seed_(seed), random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  /// Random encoders. The fine one may be finer than, equal to or coarser than the coarse one, and their
  /// counts may be commensurate or not.
  loop::EncoderParameters random_encoders() {
    loop::EncoderParameters encoders;
    encoders.coarse = std::floor(std::pow(10.0, uniform(1.0, 5.0)));
    encoders.fine = random_() % 4 == 0 ? encoders.coarse * static_cast<double>(1 + random_() % 20)
                                       : std::floor(std::pow(10.0, uniform(1.0, 6.5)));
    return encoders;
  }

  double random_phase() { return random_() % 4 == 0 ? 0.0 : uniform(0.0, 1.0); }

  unsigned seed_;
  std::mt19937 random_;
};

}  // namespace zerocount::testing
