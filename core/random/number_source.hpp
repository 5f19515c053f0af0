#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/random/random_numbers.hpp"
#include "core/random/variates.hpp"

namespace zerocount::random {

/// The random numbers of a stream one after the other, for searches that need no counter of their own.
class NumberSource {
 public:
  explicit NumberSource(const RandomKey& key, std::uint32_t stream = 0) : stream_{key, stream} {}

  /// In (0, 1).
  double uniform() { return open_uniform(next()); }
  double normal() { return standard_normal(next()); }
  std::vector<double> normals(std::size_t count) {
    std::vector<double> numbers(count);
    for (double& number : numbers) number = normal();
    return numbers;
  }

 private:
  std::uint64_t next() { return random_bits(stream_, drawn_++, Draw::trial); }

  RandomStream stream_;
  std::uint64_t drawn_{0};
};

}  // namespace zerocount::random
