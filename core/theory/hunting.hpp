#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/friction/parameters.hpp"
#include "core/loop/parameters.hpp"
#include "core/motion/parameters.hpp"
#include "core/theory/sampled_stability.hpp"

/// Predictions of hunting, the lasting oscillation of a position loop with friction.
namespace zerocount::theory {

struct LimitCycle {
  double amplitude;  ///< half of its range, rad
  double period;     ///< s
};

/// The part of the loop that invalidates both predictions, which assume a linear plant and control: "the
/// second mass", "the deadband", "the hold", "the gains at standstill" or "the integrator zone"; empty if
/// they hold.
std::string_view left_out_of_hunting(const motion::PlantParameters& plant,
                                     const loop::ControllerParameters& controller);

/// The stable limit cycles that the describing function N of friction predicts, by increasing amplitude:
/// solutions of the harmonic balance
///
///   −J·Ω² + N(A, Ω) + K(Ω) = 0
///
/// at which the net damping, its imaginary part, rises with A. K is the stiffness of the control, N m/rad:
/// its response with all its blocks, hold, delay and amplifier, the error times the describing function of
/// its dead zone. Sought between 0.3 and 1e6 counts and from 1e-4 to 0.9 of half the sample rate. A motion
/// with standstill, far from a sinusoid, is not predicted. Empty for a model without a describing function.
/// Source: as describing_function, section 3.
std::vector<LimitCycle> harmonic_balance(friction::FrictionModel model,
                                         const friction::FrictionParameters& contact,
                                         const motion::PlantParameters& plant,
                                         const loop::EncoderParameters& encoder,
                                         const loop::ControllerParameters& controller,
                                         const LinearDrive& drive = {});

/// The symmetric stick-slip cycle of a continuous PID control on Coulomb friction with a static level: the
/// rotor stands at −a until the integral has brought the torque to Fs, slides under Fc and cs to +a, and so
/// on. With the gains kP, kI, kD of analogue_gains, e = −x and w = I − Fc, a slide obeys
///
///   dx/dt = v,   J·dv/dt = w − kP·x − (kD + cs)·v,   dw/dt = −kI·x,   x(0) = −a, v(0) = 0, w(0) = Fs − Fc −
///   kP·a,
///
/// to v = 0 at x = a, and the standstill takes (u + Fs)/(kI·a), u the torque at its start. The amplitude a is
/// proportional to Fs − Fc. Empty if the loop has no such cycle: without a static level or an integral, with
/// blocks beside PID, or if every oscillation of the slides grows. Source: Armstrong and Amin, "PID
/// control in the presence of static friction: a comparison of algebraic and describing function analysis",
/// Automatica 32 (1996), 679–692.
std::optional<LimitCycle> stick_slip_cycle(const friction::FrictionParameters& contact,
                                           const motion::PlantParameters& plant,
                                           const loop::EncoderParameters& encoder,
                                           const loop::ControllerParameters& controller);

}  // namespace zerocount::theory
