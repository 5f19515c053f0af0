#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/random/random_numbers.hpp"
#include "core/random/variates.hpp"

/// The probability of a rare failure. A trial is a function of independent standard normal coordinates, and
/// of further random numbers that follow from its number.
namespace zerocount::rare {

/// A trial.
struct TrialPoint {
  std::vector<double> z;  ///< [coordinate]
  std::int64_t number{0};
};

/// The result of a trial.
struct PointResult {
  double failed{0.0};  ///< proportion of its moves that fail
  /// [score] Of its moves the largest: continuous, and larger the nearer a move is to failure, if the score
  /// is apt. NaN: not known.
  std::vector<double> scores;
};

/// Runs trials; the results in their order.
using Simulation = std::function<std::vector<PointResult>(std::span<const TrialPoint>)>;

/// A sequence of random numbers.
class NumberSource {
 public:
  explicit NumberSource(const random::RandomKey& key, std::uint32_t stream = 0) : stream_{key, stream} {}

  double uniform() { return random::open_uniform(next()); }
  double normal() { return random::standard_normal(next()); }
  std::vector<double> normals(std::size_t count) {
    std::vector<double> numbers(count);
    for (double& number : numbers) number = normal();
    return numbers;
  }

 private:
  std::uint64_t next() { return random::random_bits(stream_, drawn_++, random::Draw::trial); }

  random::RandomStream stream_;
  std::uint64_t drawn_{0};
};

}  // namespace zerocount::rare
