#pragma once

#include "core/loop/parameters.hpp"
#include "core/motion/parameters.hpp"

/// Stability of the sampled loop about a spring of constant stiffness, the count taken as a continuous
/// quantity: friction, encoder and DAC are linear; sampling, hold and delay are exact.
namespace zerocount::theory {

/// Linear model of converter and amplifier.
struct LinearDrive {
  double gain{1.0};       ///< torque per torque decided: 1 + dac.gain_error
  double bandwidth{0.0};  ///< of the amplifier, Hz; 0: it follows at once
};

/// Spectral radius (dimensionless) of the sampled loop about a spring of `stiffness` (N m/rad); below 1 it is
/// stable.
///
/// The rotor obeys J·θ¨ + c·θ˙ + k·θ = u; u is the drive's input v, held over each sample, or follows it by
/// u˙ = 2πf·(v − u), f the amplifier's bandwidth. Both are discretised exactly by the matrix exponential. The
/// controller is linear_chain(controller), with `controller.delay` samples between deciding a torque and
/// applying it (loop_map).
double sampled_spectral_radius(double stiffness, const motion::PlantParameters& plant,
                               const loop::EncoderParameters& encoder,
                               const loop::ControllerParameters& controller, const LinearDrive& drive = {});

/// The slowest time constant with which the sampled loop about a spring of `stiffness` (N m/rad) approaches
/// its target, s, by slowest_time_constant of its poles. Oscillating modes do not count.
///
/// A slow integral control has τ ≈ T·(k·Δx + kp)/(2·ki).
double slowest_time_constant(double stiffness, const motion::PlantParameters& plant,
                             const loop::EncoderParameters& encoder,
                             const loop::ControllerParameters& controller, const LinearDrive& drive = {});

/// Integral gain of the control law: ki (N m/count), or that of a cascade (N m/rad).
double integral_gain(const loop::ControllerParameters& controller);

/// Integral gain, in the unit of integral_gain, below which the sampled loop about a spring of `stiffness` (N
/// m/rad) is stable: the end of the interval of stable gains that begins at 0, to 1e-9 relative. 0 where the
/// loop without integral is unstable already. The gain of `controller` itself does not enter.
///
/// With L = L₀ + ki·L₁ the loop has a pole at z = exp(iωT) where ki = −(1 + L₀)/L₁ is a real number: the
/// bound is the smallest such gain above 1e-6 of the static stiffness. The held plant has more poles than
/// zeros, so a large enough gain drives a pole out of the unit circle; infinite if the blocks let no integral
/// through.
double sampled_critical_integral_gain(double stiffness, const motion::PlantParameters& plant,
                                      const loop::EncoderParameters& encoder,
                                      loop::ControllerParameters controller, const LinearDrive& drive = {});

}  // namespace zerocount::theory
