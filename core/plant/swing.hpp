#pragma once

#include <cmath>

namespace zerocount {

/// A swing that dies out, of a rotor held by a spring of constant stiffness k:
///
///   J·d²q/dt² + c·dq/dt + k·q = 0,
///   q(t) = exp(−γt)·(q₀·cos νt + (v₀ + γq₀)/ν·sin νt),   γ = c/2J, ν² = k/J − γ² > 0.
struct Swing {
  double cosine{0.0};         ///< q₀, rad
  double sine{0.0};           ///< (v₀ + γq₀)/ν, rad
  double decay{0.0};          ///< γ, 1/s
  double frequency{0.0};      ///< ν, rad/s
  double unnoticed_after{0};  ///< the time (s) from which q counts as 0

  /// q (rad) and dq/dt (rad/s).
  struct State {
    double elongation;
    double velocity;
  };
};

/// No larger elongation (rad) comes at the time t (s) or later.
inline double swing_bound(const Swing& swing, double t) {
  if (!(t < swing.unnoticed_after)) return 0.0;
  return std::hypot(swing.cosine, swing.sine) * std::exp(-swing.decay * t);
}

/// From the elongation q₀ (rad) and the velocity v₀ (rad/s) at t = 0 on.
/// @param decay γ, 1/s, positive. @param frequency ν, rad/s, positive.
/// @param notice amplitude (rad) below which the swing is over.
inline Swing swing_from(double elongation, double velocity, double decay, double frequency, double notice) {
  Swing swing{elongation, (velocity + decay * elongation) / frequency, decay, frequency, 0.0};
  const double largest = std::hypot(swing.cosine, swing.sine);
  if (largest > notice) swing.unnoticed_after = std::log(largest / notice) / decay;
  return swing;
}

inline Swing::State swing_at(const Swing& swing, double t) {
  if (!(t < swing.unnoticed_after)) return {0.0, 0.0};
  const double left = std::exp(-swing.decay * t);
  const double c = std::cos(swing.frequency * t);
  const double s = std::sin(swing.frequency * t);
  const double q = left * (swing.cosine * c + swing.sine * s);
  return {q, left * swing.frequency * (swing.sine * c - swing.cosine * s) - swing.decay * q};
}

}  // namespace zerocount
