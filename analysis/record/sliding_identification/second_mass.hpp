#pragma once

#include <optional>
#include <vector>

namespace zerocount::sliding_identification {

struct SlidingFit;
struct SlidingRecord;

/// A second mass coupled by a spring, found in the residuals of a fit with one rigid mass.
struct SecondMass {
  /// Proportion of the sum of squares of the residuals that the second mass explains.
  double explained{0.0};
  /// Frequency at which the two masses oscillate against each other, Hz; 0: not well known.
  double frequency{0.0};
};

/// The second mass that the records show; nothing if chance may explain the residuals of a single mass.
///
/// Masses J1 and J2 on a spring that a torque u on J1 moves are together one mass and an oscillator:
///
///   J·θ″ = u,   q″ + 2ζω·q′ + ω²·q = u/J,   θ1 = θ + J2/J1·q,   θ2 = θ − q,   J = J1 + J2.
///
/// A reading thus has A·q more than that of one mass: A = J2/J1 on the driven mass, A = −1 on the other. q
/// follows from the torque, so errors of the readings do not drive it. For many ω and ζ, A is fitted with the
/// parameters of the fit, by one step of Gauss and Newton, with free initial states of q in each window.
///
/// The second mass counts as visible under three conditions. A explains at least 3 % of the squares of the
/// residuals. A exceeds its standard error by so much that chance does the same in one of 1000 records, in
/// any of 100 places. No torque of tried_torques() explains more. The standard error is the larger one of
/// two: that for independent residuals, and that of the jackknife over windows.
///
/// Three lengths of windows are tried: a twentieth of the samples, 256 and 128 samples. In long windows,
/// forces that the law lacks hide A. In closed loop, short windows imitate a small A, because the torque and
/// the free initial states depend on the same errors of the readings.
std::optional<SecondMass> visible_second_mass(const SlidingFit& fit, std::vector<SlidingRecord> records);

}  // namespace zerocount::sliding_identification
