#pragma once

#include <functional>
#include <string_view>

#include "core/friction/parameters.hpp"
#include "core/loop/parameters.hpp"
#include "core/motion/parameters.hpp"

/// The stability criteria and design rules of Lin, Pan and Hsieh (2002), "Precision-limit positioning of
/// direct drive systems with the existence of friction", sections 3 and 4 ("the paper").
namespace zerocount::theory {

// Stability of the sampled loop about a spring of constant stiffness, the count taken as a continuous
// quantity: friction, encoder and DAC are linear; sampling, hold and delay are exact.
//
// The rotor obeys J·θ¨ + c·θ˙ + k·θ = u; u is the drive's input v, held over each sample, or follows it by
// u˙ = 2πf·(v − u), f the amplifier's bandwidth. Both are discretised exactly by the matrix exponential. The
// controller is linear_chain(controller), with `controller.delay` samples between deciding a torque and
// applying it (loop_map). The loop is stable if all eigenvalues of its map lie inside the unit circle.

/// Linear model of digital-to-analogue converter and amplifier.
struct LinearDrive {
  double gain{1.0};       ///< Gain from the torque decided to the torque given: 1 + dac.gain_error
  double bandwidth{0.0};  ///< Bandwidth of the amplifier, Hz; 0: the torque follows at once
};

/// Integral gain of the control law: ki of the PID law (N m/count), or ki of the cascade (N m/rad).
double integral_gain(const loop::ControllerParameters& controller);

struct FrozenLoop;

/// Integral gain, in the unit of integral_gain, below which a frozen loop is stable: the end of the interval
/// of stable gains that begins at 0, to 1e-9 relative. 0 where the loop without integral is unstable already.
/// The gain of `controller` itself does not enter.
///
/// With L = L₀ + ki·L₁ the loop has a pole at z = exp(iωT) where ki = −(1 + L₀)/L₁ is a real number: the
/// bound is the smallest such gain above 1e-6 of the static stiffness. The held plant has more poles than
/// zeros, so a large enough gain drives a pole out of the unit circle; infinite if the blocks let no integral
/// through.
/// @param loop_with gives the loop with a controller that differs only in its integral gain.
/// @param scale static stiffness of the loop without integral, in the unit of integral_gain
double sampled_critical_integral_gain(
    const std::function<FrozenLoop(const loop::ControllerParameters&)>& loop_with,
    loop::ControllerParameters controller, double scale);

/// Static stiffness of the contact's spring and the control law without its integral, in the unit of
/// integral_gain(): N m/count or N m/rad.
/// @param stiffness stiffness of the spring, N m/rad.
double static_stiffness(double stiffness, const loop::EncoderParameters& encoder,
                        const loop::ControllerParameters& controller);

/// The part of the loop that the paper's criteria (6) and (7) do not model, so that they do not apply, as a
/// noun for messages: "the second mass", "the cascade", "the filters", …; empty if the criteria apply. A
/// derivative filter does not count if kd is 0.
std::string_view left_out_of_criteria(const motion::PlantParameters& plant,
                                      const loop::ControllerParameters& controller);

/// Digital integral gain k_ID (N m/count) at which the continuous loop about a spring of constant stiffness k
/// (N m/rad) is on the edge of stability:
///
///   k_ID = ((c + kD)·(k + kP)/J)·Δx·T/2,  kP = kp/Δx,  kD = kd·T/Δx.
///
/// This is the Hurwitz condition of J·s³ + (c + kD)·s² + (k + kP)·s + kI = 0; with k = k1 it is the paper's
/// (6), with k = k1 + k2 its (7). The gain `controller.ki` and the delay do not enter.
double critical_integral_gain(double stiffness, const motion::PlantParameters& plant,
                              const loop::EncoderParameters& encoder,
                              const loop::ControllerParameters& controller);

/// The paper's two stability criteria for one contact, as bounds on the digital integral gain.
struct IntegralGainBounds {
  double stable_below{0.0};    ///< Bound of criterion (6), with k = k1: the loop is stable for all histories
                               /// < if the gain is below it, N m/count
  double unstable_above{0.0};  ///< Bound of criterion (7), with k = k1 + k2: the loop is unstable if the gain
                               /// < is above it, N m/count
};

/// The bounds of the paper's criteria (6) and (7) on the digital integral gain, for the friction parameters
/// `contact`.
IntegralGainBounds integral_gain_bounds(const motion::PlantParameters& plant,
                                        const friction::FrictionParameters& contact,
                                        const loop::EncoderParameters& encoder,
                                        const loop::ControllerParameters& controller);

/// Lowest k1, the final stiffness of the contact's spring (N m/rad), over a whole revolution. The paper says
/// to use it in criterion (6) for a robust design (issue 1 of its section 3).
double lowest_k1(const friction::FrictionAlongRotor& friction);

/// Torque step Δu (N m) that the DAC must stay below for a zero-count error to be possible: k1·Δx (issue 4 of
/// the paper's section 3: one code moves the rotor by at most Δu/k1). Δx is of the encoder that is fed back.
double dac_resolution_bound(double k1, const loop::EncoderParameters& encoder,
                            loop::EncoderChoice feedback = loop::EncoderChoice::fine);

/// Natural frequency √(stiffness/J)/2π of the rotor on a spring, Hz.
/// @param stiffness N m/rad; with k1 + k2 the result is the highest natural frequency of the pre-sliding
/// motion.
double natural_frequency(double stiffness, const motion::PlantParameters& plant);

/// Lowest advisable sample rate (Hz): ten times the highest natural frequency, as on the paper's machine
/// (section 4 of the paper).
double advised_sample_rate(const motion::PlantParameters& plant, const friction::FrictionParameters& contact);

}  // namespace zerocount::theory
