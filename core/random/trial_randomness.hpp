#pragma once

#include <cstdint>

#include "core/random/random_numbers.hpp"

namespace zerocount::random {

/// Streams of the random numbers that are drawn while a trial runs. The trial index and the stream are the
/// counter words of the same name (random_numbers.hpp).
struct TrialRandomness {
  std::uint64_t trial{0};
  std::uint32_t stream{0};
  RandomKey history{};
  RandomKey fine_noise{};
  RandomKey fine_missed{};
  RandomKey coarse_noise{};
  RandomKey coarse_missed{};
  RandomKey dac_noise{};
  RandomKey missed_samples{};
  RandomKey jitter{};
  RandomKey spectrum{};
  RandomKey other_noise{};
  RandomKey other_missed{};
};

}  // namespace zerocount::random
