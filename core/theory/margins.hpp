#pragma once

#include <complex>
#include <functional>
#include <vector>

#include "core/theory/frozen_loop.hpp"

/// Gain and phase margins of the sampled loop, from its exact frequency response
///
///   L(z) = C(z)·G(z),  z = exp(iωT),  0 < ω ≤ π/T,
///
/// of a FrozenLoop, and the peak of its sensitivity S = 1/(1 + L). Source of the definitions: Franklin,
/// Powell, Workman, "Digital Control of Dynamic Systems", 3rd ed., Addison-Wesley 1998, section 7.4.
namespace zerocount::theory {

// Where the frequency response L(z), z = exp(i·ωT), of a loop crosses the unit circle and the negative real
// axis. Angles are ωT, 0 < ωT < π.

/// Function that gives the complex frequency response at an angle ωT (rad).
using Response = std::function<std::complex<double>(double angle)>;

/// Angles in increasing order that show the shape of L: from a millionth of π to just below π, spread by
/// their logarithm; closer where the delay turns the phase by more than 0.3 rad from one to the next; and
/// around the plant's poles and the controller's poles and zeros by their distance from the unit circle. At a
/// pole on the circle, where L is infinite, there is none.
std::vector<double> search_angles(const FrozenLoop& loop);

/// Inserts angles around the angles of these poles or zeros of the loop; `angles` stays in increasing order.
void add_angles_around(const Eigen::VectorXcd& roots, std::vector<double>& angles);

/// A frequency response as a function, with its values at angles that show its shape.
struct SampledResponse {
  Response at;
  std::vector<double> angles;                  ///< Angles ωT, rad, in increasing order
  std::vector<std::complex<double>> values{};  ///< Values of the frequency response, [angle]
};
SampledResponse sampled(Response response, std::vector<double> angles);

/// The angles ωT (rad) at which the absolute value of the response passes 1. Pairs of crossings between two
/// sampled angles are sought if |response| comes near 1 there.
std::vector<double> gain_crossovers(const SampledResponse& response);

/// The angles ωT (rad) at which the response passes the real axis, other than through infinity.
std::vector<double> phase_crossovers(const SampledResponse& response);

/// A stability margin and the frequency (Hz) of its crossover; both NaN without a crossover.
struct Margin {
  double value;
  double frequency;
};

/// The highest frequency at which the open loop has gain 1, and the phase margin there. It matters while the
/// rotor slides: the plant is then 1/(J·s² + cs·s), and the friction torque, constant well above the Stribeck
/// velocity, is a disturbance that the loop has to reject.
struct GainCrossover {
  /// Highest frequency with |L| = 1, Hz: the bandwidth of the loop. NaN where |L| < 1 throughout, or |L| ≥ 1
  /// up to half the sample rate.
  double frequency;
  /// Phase margin 180° + arg L at this frequency, in (−180, 180]. If it is negative, the loop is unstable
  /// while it slides. NaN without a crossover.
  double phase_margin;
};

/// Gain and phase margins of a loop. If there are several crossovers, each margin belongs to the crossover
/// nearest to instability.
struct StabilityMargins {
  /// 1/|L| where L is negative: the factor of the gain at which the loop is on the edge of stability, the
  /// nearest to 1 by ratio. A factor below 1 limits a decrease of the gain, or is the decrease that an
  /// unstable loop needs. If no factor of the gain makes an unstable loop stable, there is none.
  Margin gain;
  /// Phase margin, degrees: 180° + arg L at a frequency where |L| = 1, in (−180, 180]; of several, the value
  /// nearest to 0.
  Margin phase;
  GainCrossover crossover;
  bool no_gain_stabilises{false};  ///< Whether the loop is unstable with every factor of its gain
};

/// Mₛ, the largest |S| over 0 < ω ≤ π/T, and its frequency: the distance of L from −1 is 1/Mₛ. A stable loop
/// has a gain margin of at least Mₛ/(Mₛ − 1), and a phase margin of at least 2·asin(1/(2·Mₛ)). The peaks are
/// sought between the search_angles by Brent's method. Source: Åström, Hägglund, "Advanced PID Control", ISA
/// 2006, section 4.6.
Margin peak_sensitivity(const FrozenLoop& loop);

/// Computes the margins of a loop. The crossovers are searched between the search_angles, then bisected to
/// 1e-12.
StabilityMargins stability_margins(const FrozenLoop& loop);

}  // namespace zerocount::theory
