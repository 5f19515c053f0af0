#pragma once

#include <cmath>
#include <numbers>

#include "core/friction/presliding/presliding_formulas.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::friction {

/// A decaying oscillation so small that each side of a loop of the spring is a parabola, and the rate of
/// creep is linear in σ:
///
///   dq/dt = v − ξ·q,   J·dv/dt = −c·v − σ(q),   de/dt = ξ·q,   ξ = k·dp/d|σ|,   k = k1 + k2,
///   σ = (k − k2·β·a)·q ± ½·k2·β·(a² − q²),
///
/// where q and e are the deviations of elongation and creep from their final values, a the amplitude, and the
/// sign is + where q grows and − where it falls. (The branch law to second order in β·a.) With γ = (c/J +
/// ξ)/2, ω² = (k + c·ξ)/J and ν² = ω² − γ², by the method of averaging (Nayfeh, Perturbation Methods,
/// section 5.2),
///
///   q = a/a₀·(q₀·cos φ + (q₀′ + γq₀)/ν·sin φ),   e = −ξ·(dq/dt + 2γ·q)/ω²,
///   da/dt = −γ·a − η·a²,      η = 2/(3π)·ν·k2·β/k,
///   dφ/dt = ν·(1 − κ·a),      κ = ½·k2·β/k.
///
/// The truncation error is of the order β·a² and does not grow with the number of periods.
struct ResidualOscillation : OscillationConstants<double> {
  double end{0.0};        ///< Time from which the oscillation counts as ended, q = 0, s
  double amplitude{0.0};  ///< Initial amplitude a₀, rad

  using State = OscillationState<double>;
};

/// Coefficients of the residual oscillation of a rotor at rest, which must be underdamped: 0 < γ² < ω².
struct OscillationLaw {
  double decay;      ///< Decay rate γ, 1/s
  double frequency;  ///< Angular frequency ν, rad/s
  double creep;      ///< Rate ξ of creep per elongation, 1/s
  double softening;  ///< Relative loss of stiffness per amplitude, k2·β/k, 1/rad
};

/// Creates the residual oscillation that starts at t = 0 with the elongation q₀ (rad) and the velocity v₀
/// (rad/s).
/// @param min_amplitude amplitude (rad) below which the oscillation counts as ended.
inline ResidualOscillation residual_oscillation(const OscillationLaw& law, double elongation, double velocity,
                                                double min_amplitude) {
  const double rate = velocity - law.creep * elongation;
  ResidualOscillation oscillation{
      {elongation, (rate + law.decay * elongation) / law.frequency, law.decay, law.frequency, law.creep}};
  const double amplitude =
      std::sqrt(oscillation.cosine * oscillation.cosine + oscillation.sine * oscillation.sine);
  oscillation.amplitude = amplitude;
  oscillation.loss = 2.0 / 3.0 * std::numbers::inv_pi * law.frequency * law.softening * amplitude;
  oscillation.slowing = 0.5 * law.softening * amplitude;
  if (amplitude > min_amplitude) oscillation.end = numerics::log(amplitude / min_amplitude) / law.decay;
  return oscillation;
}

/// Upper bound of |q + e| (rad), the deviation of the rotor from quasi-static creep, at the time t (s) and
/// later.
inline double oscillation_bound(const ResidualOscillation& oscillation, double t) {
  if (!(t < oscillation.end)) return 0.0;
  const double of_creep = 1.0 + 4.0 * oscillation.creep / oscillation.frequency;
  return of_creep * oscillation.amplitude * numerics::exp(-oscillation.decay * t);
}

inline ResidualOscillation::State oscillation_at(const ResidualOscillation& oscillation, double t) {
  if (!(t < oscillation.end)) return {0.0, 0.0, 0.0};
  const OscillationPhase<double> now =
      oscillation_phase<double>(oscillation, -numerics::expm1(-oscillation.decay * t), t);
  const auto [s, c] = numerics::sine_and_cosine(now.phase);
  return oscillation_state<double>(oscillation, now.amplitude, s, c);
}

}  // namespace zerocount::friction
