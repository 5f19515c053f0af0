#pragma once

#include <cmath>
#include <numbers>

namespace zerocount::friction {

/// Swings that die out, so small that a loop of the spring is a parabola on either side, and the rate of
/// creep a straight line in σ:
///
///   dq/dt = v − ξ·q,   J·dv/dt = −c·v − σ(q),   de/dt = ξ·q,   ξ = k·dp/d|σ|,   k = k1 + k2,
///   σ = (k − k2·β·a)·q ± ½·k2·β·(a² − q²),
///
/// q and e what elongation and creep have beyond those to which they come, + where q grows and − where it
/// falls, a the amplitude. (The branch law to second order in β·a.) With γ = (c/J + ξ)/2, ω² = (k + c·ξ)/J
/// and ν² = ω² − γ², by the method of averaging (Nayfeh, Perturbation Methods, section 5.2),
///
///   q = a/a₀·(q₀·cos φ + (q₀′ + γq₀)/ν·sin φ),   e = −ξ·(dq/dt + 2γ·q)/ω²,
///   da/dt = −γ·a − η·a²,      η = 2/(3π)·ν·k2·β/k,
///   dφ/dt = ν·(1 − κ·a),      κ = ½·k2·β/k.
///
/// What is left out comes to some β·a² and does not grow with the number of swings.
struct Swing {
  double cosine{0.0};         ///< q₀, rad
  double sine{0.0};           ///< (q₀′ + γq₀)/ν, rad
  double decay{0.0};          ///< γ, 1/s
  double frequency{0.0};      ///< ν, rad/s
  double creep{0.0};          ///< ξ, 1/s
  double loss{0.0};           ///< η·a₀, 1/s
  double slowing{0.0};        ///< κ·a₀
  double unnoticed_after{0};  ///< the time (s) from which q counts as 0

  struct State {
    double elongation;  ///< q, rad
    double extension;   ///< e, rad
    double velocity;    ///< v, rad/s
  };
};

/// The law of the swings of a rotor, where it swings at all: 0 < γ² < ω².
struct SwingLaw {
  double decay;      ///< γ, 1/s
  double frequency;  ///< ν, rad/s
  double creep;      ///< ξ, 1/s
  double softening;  ///< k2·β/k, 1/rad
};

/// From the elongation q₀ (rad) and the velocity v₀ (rad/s) at t = 0 on.
/// @param notice amplitude (rad) below which the swing is over.
inline Swing swing_from(const SwingLaw& law, double elongation, double velocity, double notice) {
  const double rate = velocity - law.creep * elongation;
  Swing swing{elongation, (rate + law.decay * elongation) / law.frequency, law.decay, law.frequency,
              law.creep};
  const double amplitude = std::hypot(swing.cosine, swing.sine);
  swing.loss = 2.0 / 3.0 * std::numbers::inv_pi * law.frequency * law.softening * amplitude;
  swing.slowing = 0.5 * law.softening * amplitude;
  if (amplitude > notice) swing.unnoticed_after = std::log(amplitude / notice) / law.decay;
  return swing;
}

/// θ is no farther (rad) from where it comes to at the time t (s) or later.
inline double swing_bound(const Swing& swing, double t) {
  if (!(t < swing.unnoticed_after)) return 0.0;
  const double of_creep = 1.0 + 4.0 * swing.creep / swing.frequency;
  return of_creep * std::hypot(swing.cosine, swing.sine) * std::exp(-swing.decay * t);
}

inline Swing::State swing_at(const Swing& swing, double t) {
  if (!(t < swing.unnoticed_after)) return {0.0, 0.0, 0.0};
  // a/a₀ = exp(−γt)/(1 + x) and ∫a/a₀ dt = log(1 + x)/(η·a₀), x = η·a₀·(1 − exp(−γt))/γ.
  const double died = -std::expm1(-swing.decay * t) / swing.decay;
  const double x = swing.loss * died;
  const double amplitude = std::exp(-swing.decay * t) / (1.0 + x);
  const double phase = swing.frequency * (t - swing.slowing * died * (1.0 - 0.5 * x));
  const double c = std::cos(phase);
  const double s = std::sin(phase);
  const double q = amplitude * (swing.cosine * c + swing.sine * s);
  const double falls = swing.decay + swing.loss * amplitude;
  const double turns = swing.frequency * (1.0 - swing.slowing * amplitude);
  const double rate = amplitude * turns * (swing.sine * c - swing.cosine * s) - falls * q;
  const double per_time_squared = swing.frequency * swing.frequency + swing.decay * swing.decay;
  const double extension = -swing.creep * (rate + 2.0 * swing.decay * q) / per_time_squared;
  return {q, extension, rate + swing.creep * q};
}

}  // namespace zerocount::friction
