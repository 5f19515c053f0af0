#include "core/theory/sliding_loop.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "core/theory/crossovers.hpp"

namespace zerocount::theory {

GainCrossover gain_crossover(const FrozenLoop& loop) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto response = [&](double angle) { return open_loop(loop, angle); };
  if (std::abs(response(std::numbers::pi)) >= 1.0) return {none, none};
  const std::vector<double> crossovers = gain_crossovers(response, search_angles(loop));
  if (crossovers.empty()) return {none, none};
  const double highest = crossovers.back();
  return {highest / (2.0 * std::numbers::pi * loop.sample_time),
          std::arg(-response(highest)) * 180.0 / std::numbers::pi};
}

}  // namespace zerocount::theory
