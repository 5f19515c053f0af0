#pragma once

#include <cstdint>

#include "core/loop/parameters.hpp"

namespace zerocount {

std::int64_t lowest_code(const DacParameters& dac);   ///< −2^(bits−1)
std::int64_t highest_code(const DacParameters& dac);  ///< 2^(bits−1) − 1

/// What the converter makes of a wanted torque.
struct DacOutput {
  std::int64_t code{0};
  double torque{0.0};   ///< code·Δu, N m
  bool clipped{false};  ///< the wanted code was out of range
};

/// code = round-half-even(torque/Δu), clipped to the converter's range.
/// @param torque wanted, N m.
DacOutput convert(const DacParameters& dac, double torque);

}  // namespace zerocount
