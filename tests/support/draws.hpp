#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "core/numerics/elementary_functions.hpp"

namespace zerocount::testing {

/// Random numbers with a fixed seed, the same bits with every standard library and processor.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(engine_() >> 11), -53);
  }
  double log_uniform(double low, double high) {
    return numerics::exp(uniform(numerics::log(low), numerics::log(high)));
  }
  std::int64_t integer(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  /// A standard normal number (Box and Muller, 1958).
  double normal() {
    const double radius = std::sqrt(-2.0 * numerics::log(1.0 - uniform(0.0, 1.0)));
    return radius * numerics::cos(2.0 * std::numbers::pi * uniform(0.0, 1.0));
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  int sign() { return chance(0.5) ? 1 : -1; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace zerocount::testing
