#pragma once

#include "core/loop/parameters.hpp"
#include "core/loop/transfer_function.hpp"
#include "core/motion/parameters.hpp"
#include "core/theory/held_plant.hpp"

/// Gain and phase margins of the sampled loop, from its exact frequency response
///
///   L(z) = C(z)·z^(−delay)·G(z),  z = exp(iωT),  0 < ω ≤ π/T,
///
/// where C is the controller with all its blocks away from their limits, and G the plant in counts, held over
/// each sample. Source of the definitions: Franklin, Powell, Workman, "Digital Control of Dynamic Systems",
/// 3rd ed., Addison-Wesley 1998, section 7.4.
namespace zerocount::theory {

/// A margin and the frequency (Hz) of its crossover; both NaN where there is no crossover.
struct Margin {
  double value;
  double frequency;
};

/// Where a loop has several crossovers, each margin is that of the one nearest to instability.
struct StabilityMargins {
  /// 1/|L| where L is negative: the factor of the gain with which the loop is on the edge of stability. Of
  /// all such frequencies the one with |L| nearest to 1, by their ratio. A factor below 1 is by how far the
  /// gain may fall, or of an unstable loop has to.
  Margin gain;
  /// 180° + arg L where |L| = 1, in (−180, 180]: of all such frequencies the one nearest to 0.
  Margin phase;
};

/// The crossovers are searched between points that are spread over 1e-6·π/T to π/T by their logarithm, and
/// around the poles and zeros near the unit circle by their width; then bisected to 1e-12.
/// @param sample_time T, s.
StabilityMargins stability_margins(const HeldPlant& plant, const loop::LinearChain& controller, int delay,
                                   double sample_time);

/// The margins of the loop about a spring of `stiffness` (N m/rad) with the damping c (N m s/rad). While the
/// rotor slides there is no spring, and the damping is the sliding one.
StabilityMargins margins_about(double stiffness, double damping, const motion::PlantParameters& plant,
                               const loop::EncoderParameters& encoder,
                               const loop::ControllerParameters& controller, const LinearDrive& drive = {});

}  // namespace zerocount::theory
