#pragma once

#include <complex>

#include "core/friction/parameters.hpp"
#include "core/loop/parameters.hpp"
#include "core/motion/parameters.hpp"

namespace zerocount::theory {

/// The describing function of friction: the fundamental of F over that of θ = A·sin Ωt, in steady state,
///
///   N(A, Ω) = (Ω/πA)·∫ F(t)·(sin Ωt + i·cos Ωt) dt over a period,
///
/// N m/rad (Gelb and Vander Velde, "Multiple-Input Describing Functions and Nonlinear System Design",
/// McGraw-Hill 1968, section 2.2). Its real part is a stiffness, its imaginary part Ω times a damping, the
/// viscous damping among it.
///
/// For a relay (coulomb), F = sgn(ω)·g(ω) + cs·ω; for a bristle (dahl, lugre), the bristle follows θ. Defined
/// for these laws alone.
/// @param amplitude A, rad. @param frequency Ω, rad/s.
std::complex<double> describing_function(friction::FrictionModel model,
                                         const friction::FrictionParameters& contact,
                                         const motion::PlantParameters& plant, double amplitude,
                                         double frequency);

/// The describing function of a dead zone of the error, dimensionless: with sin φ = band/A,
///
///   zero      1 − 2/π·(φ − sin φ·cos φ),      subtract   1 − 2/π·(φ + sin φ·cos φ),
///
/// and 0 for A ≤ band (Gelb and Vander Velde, appendix B). @param amplitude A of the error, counts.
double describing_function(const loop::ErrorDeadband& deadband, double amplitude);

/// Whether the model has a describing function here.
bool has_describing_function(friction::FrictionModel model);

}  // namespace zerocount::theory
