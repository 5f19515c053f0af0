#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/random/number_source.hpp"

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

using random::NumberSource;

}  // namespace zerocount::rare
