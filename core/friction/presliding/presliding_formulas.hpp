#pragma once

#include "core/numerics/number.hpp"

namespace zerocount::friction {

/// One branch of the spring's hysteresis (paper, eq. 1):
///
///   σ(x) = σr + s·[k1·|x − xr| + (softening_torque)·(1 − exp(−softening_rate·|x − xr|))],   s = sgn(x − xr).
///
/// An ordinary branch starts at the last reversal point with softening_rate = β and softening_torque = k2/β.
/// The virgin curve σ(x) = sgn(x)·½·f(2|x|) is the same law from the origin with 2β and k2/(2β).
/// @tparam Number double, or a vector of the batch engine.
template <class Number>
struct SpringBranchOf {
  Number elongation{0.0};        ///< Elongation xr at which the branch starts, rad
  Number torque{0.0};            ///< Spring torque σr at which the branch starts, N m
  Number sign{1.0};              ///< Side s of xr on which the branch lies: −1 or 1
  Number k1{0.0};                ///< Final (lowest) tangent stiffness, N m/rad
  Number softening_torque{0.0};  ///< Torque by which the branch exceeds the line of slope k1 after a long
                                 /// < travel, N m
  Number softening_rate{0.0};    ///< Rate at which the branch softens to the stiffness k1, 1/rad
};

/// Travel |x − xr| along the hysteresis branch from its start to the elongation x (rad).
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number travel_on(const SpringBranchOf<Number>& branch, const Number& x) {
  return branch.sign * (x - branch.elongation);
}

/// Spring torque σ (N m) on a hysteresis branch after the travel |x − xr| (rad).
/// @param softened 1 − exp(−softening_rate·|x − xr|).
template <class Number>
ZEROCOUNT_ALWAYS_INLINE Number torque_after(const SpringBranchOf<Number>& branch, const Number& travel,
                                            const Number& softened) {
  return branch.torque + branch.sign * (branch.k1 * travel + branch.softening_torque * softened);
}

// The formulas of ResidualOscillation, for double and for the vectors of the batch engine.

template <class Number>
struct OscillationConstants {
  Number cosine{0.0};     ///< Amplitude of the cosine: initial elongation q₀, rad
  Number sine{0.0};       ///< Amplitude of the sine: (q₀′ + γq₀)/ν, rad
  Number decay{0.0};      ///< Decay rate γ, 1/s
  Number frequency{0.0};  ///< Angular frequency ν, rad/s
  Number creep{0.0};      ///< Rate ξ of creep per elongation, 1/s
  Number loss{0.0};       ///< Loss by hysteresis at the initial amplitude: η·a₀, 1/s
  Number slowing{0.0};    ///< Reduction of the frequency by softening at the initial amplitude: κ·a₀,
                          /// < dimensionless
};

template <class Number>
struct OscillationPhase {
  Number amplitude;  ///< Amplitude divided by the initial amplitude, a/a₀
  Number phase;      ///< Phase φ of the oscillation, rad
};

/// Amplitude and phase of the residual oscillation (see ResidualOscillation) at the time t. With x = η·a₀·(1
/// − exp(−γt))/γ, a/a₀ = exp(−γt)/(1 + x) and ∫a/a₀ dt = log(1 + x)/(η·a₀).
/// @param decayed 1 − exp(−γt).
/// @param t time since the oscillation began, s
template <class Number>
ZEROCOUNT_ALWAYS_INLINE OscillationPhase<Number> oscillation_phase(const OscillationConstants<Number>& of,
                                                                   const Number& decayed, const Number& t) {
  const Number elapsed = decayed / of.decay;
  const Number x = of.loss * elapsed;
  return {(Number(1.0) - decayed) / (Number(1.0) + x),
          of.frequency * (t - of.slowing * elapsed * (Number(1.0) - Number(0.5) * x))};
}

template <class Number>
struct OscillationState {
  Number elongation;  ///< Deviation q of the spring's elongation from its final value, rad
  Number extension;   ///< Deviation e of the plastic extension from its final value, rad
  Number velocity;    ///< Velocity v of the rotor, rad/s
};

/// State of the residual oscillation (see ResidualOscillation) with a given amplitude and phase.
/// @param amplitude a/a₀, the amplitude divided by the initial one.
/// @param s sin φ.
/// @param c cos φ.
template <class Number>
ZEROCOUNT_ALWAYS_INLINE OscillationState<Number> oscillation_state(const OscillationConstants<Number>& of,
                                                                   const Number& amplitude, const Number& s,
                                                                   const Number& c) {
  const Number q = amplitude * (of.cosine * c + of.sine * s);
  const Number decay = of.decay + of.loss * amplitude;
  const Number frequency = of.frequency * (Number(1.0) - of.slowing * amplitude);
  const Number rate = amplitude * frequency * (of.sine * c - of.cosine * s) - decay * q;
  const Number per_time_squared = of.frequency * of.frequency + of.decay * of.decay;
  const Number extension = -of.creep * (rate + Number(2.0) * of.decay * q) / per_time_squared;
  return {q, extension, rate + of.creep * q};
}

}  // namespace zerocount::friction
