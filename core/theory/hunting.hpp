#pragma once

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
/// its dead zone. Sought between 1 and 1e6 counts and from 1e-4 to 0.9 of half the sample rate. A motion
/// with standstill, far from a sinusoid, is not predicted. Empty for a model without a describing function.
/// Source: as describing_function, section 3.
std::vector<LimitCycle> harmonic_balance(friction::FrictionModel model,
                                         const friction::FrictionParameters& contact,
                                         const motion::PlantParameters& plant,
                                         const loop::EncoderParameters& encoder,
                                         const loop::ControllerParameters& controller,
                                         const LinearDrive& drive = {});

/// The cycle of slides and standstills to which a first step of `first_step` counts leads, on a relay of
/// friction or a bristle: none, if the axis comes to rest or the slides grow without bound, or one.
///
/// The motion of the sampled loop is followed with all linear blocks of the control, hold, delay and
/// amplifier, and the count a continuous quantity. A slide obeys J·dω/dt = u − F − d·ω, with the level g at
/// the mean velocity of each sample, and F = sgn(ω)·g of a relay, F = σ0·z + σ1·dz/dt of a bristle, whose z
/// follows g over a travel of g/σ0. It ends at ω = 0, located within the sample. There the rotor stands,
/// without the elastic travel of the bristle, until |u| exceeds breakaway; for ever if it stands less than
/// half a count from the target, which the encoder does not tell from it. A cycle below one count is none.
/// Where the loop is continuous and g falls at once from Fs to Fc, this is the cycle of Armstrong and Amin,
/// "PID control in the presence of static friction: a comparison of algebraic and describing function
/// analysis", Automatica 32 (1996), 679–692, whose amplitude is proportional to Fs − Fc.
std::vector<LimitCycle> stick_slip_cycle(friction::FrictionModel model,
                                         const friction::FrictionParameters& contact,
                                         const motion::PlantParameters& plant,
                                         const loop::EncoderParameters& encoder,
                                         const loop::ControllerParameters& controller,
                                         const LinearDrive& drive, double first_step);

}  // namespace zerocount::theory
