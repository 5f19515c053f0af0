#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/random/number_source.hpp"

/// The probability of a rare failure. A trial is a function of independent standard normal coordinates, and
/// of further random numbers that follow from its number.
namespace zerocount::rare {

/// A trial: the point at which the function is taken.
struct TrialPoint {
  std::vector<double> z;   ///< [coordinate]
  std::int64_t number{0};  ///< of which all other random numbers of the trial follow
};

/// The result of a trial.
struct PointResult {
  double failed{0.0};  ///< proportion of its moves that fail
  /// [score] The largest of its moves, continuous; a useful score is larger the nearer a move is to failure.
  /// NaN: not known.
  std::vector<double> scores;
};

/// Runs trials; the results in their order.
using Simulation = std::function<std::vector<PointResult>(std::span<const TrialPoint>)>;

using random::NumberSource;

}  // namespace zerocount::rare
