#pragma once

#include <cstddef>
#include <vector>

#include "core/theory/frozen_loop.hpp"

namespace zerocount::theory {

/// A value of an open loop L.
struct BodePoint {
  double frequency{0.0};  ///< Hz
  double magnitude{0.0};  ///< 20·lg|L|, dB
  double phase{0.0};      ///< arg L without jumps of 360°, degrees
};

inline constexpr std::size_t max_bode_points = 200;

/// The open loop from `lowest` (Hz) to half of the sample rate, at most max_bode_points points of it: those
/// between which straight lines over the logarithm of the frequency show the curve best, and those at the
/// frequencies `kept` (Hz). Empty where L is 0.
///
/// The phase begins between −300° and 60°, which has room for an integrator and a rotor without a spring, and
/// continues by the smaller turn between points that lie close enough for it. An undamped resonance turns it
/// by −180°, an undamped antiresonance by 180°: the limits of small damping.
std::vector<BodePoint> bode_curve(const FrozenLoop& loop, double lowest,
                                  const std::vector<double>& kept = {});

}  // namespace zerocount::theory
