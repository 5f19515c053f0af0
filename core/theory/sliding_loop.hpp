#pragma once

#include "core/loop/parameters.hpp"
#include "core/motion/parameters.hpp"
#include "core/theory/frozen_loop.hpp"

/// The loop while the rotor slides. The plant is 1/(J·s² + cs·s), without a spring, and the friction torque,
/// constant at speeds well above the Stribeck velocity, is a disturbance that the loop has to reject.
namespace zerocount::theory {

/// The highest frequency at which the open loop has gain 1.
struct GainCrossover {
  /// Highest frequency with |L| = 1, Hz: the bandwidth of the loop. NaN where |L| < 1 throughout, or |L| ≥ 1
  /// up to half the sample rate.
  double frequency;
  /// 180° + arg L there, in (−180, 180]; negative: the loop is unstable while it slides. NaN without a
  /// crossover.
  double phase_margin;
};

/// The gain crossover of a loop, from its exact frequency response L(z), z = exp(iωT), 0 < ω ≤ π/T.
GainCrossover gain_crossover(const FrozenLoop& loop);

}  // namespace zerocount::theory
