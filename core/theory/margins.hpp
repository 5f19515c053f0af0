#pragma once

#include "core/theory/frozen_loop.hpp"

/// Gain and phase margins of the sampled loop, from its exact frequency response
///
///   L(z) = C(z)·G(z),  z = exp(iωT),  0 < ω ≤ π/T,
///
/// of a FrozenLoop. Source of the definitions: Franklin, Powell, Workman, "Digital Control of Dynamic
/// Systems", 3rd ed., Addison-Wesley 1998, section 7.4.
namespace zerocount::theory {

/// A margin and the frequency (Hz) of its crossover; both NaN without a crossover.
struct Margin {
  double value;
  double frequency;
};

/// Where a loop has several crossovers, each margin is that of the one nearest to instability.
struct StabilityMargins {
  /// 1/|L| where L is negative: the factor of the gain at which the loop is on the edge of stability, at the
  /// frequency where |L| is nearest to 1 by ratio. A factor below 1 limits a decrease of the gain, or is the
  /// decrease that an unstable loop needs.
  Margin gain;
  /// 180° + arg L where |L| = 1, in (−180, 180]: the value nearest to 0.
  Margin phase;
};

/// The crossovers are searched between the search_angles, then bisected to 1e-12.
StabilityMargins stability_margins(const FrozenLoop& loop);

}  // namespace zerocount::theory
