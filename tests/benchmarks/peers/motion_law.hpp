#pragma once

#include <array>
#include <cmath>

namespace zerocount::testing {

/// The state that the peers integrate. While the hook sticks: elongation xs (rad), ω·τ (rad), hardening xh
/// (rad). While it slides: θ (rad), ω·τ (rad), 0. The time τ = 1/ω₀, ω₀² = (k1 + k2)/J, gives all components
/// the same unit and order of magnitude, so that one tolerance fits them all.
using PeerState = std::array<double, 3>;

/// The equations of motion on one branch of the spring, or of one slide, under a constant torque (paper, eqs.
/// 1 to 4, with creep kept), with everything worked out beforehand that does not change there.
struct PeerMotionLaw {
  double torque{0.0};           ///< torque u on the rotor, N m
  double per_tau{1.0};          ///< 1/τ with the time unit τ = 1/ω₀ of the state, 1/s
  double tau_per_inertia{0.0};  ///< τ over the moment of inertia J, 1/(N m s)
  double damping{0.0};        ///< viscous damping, N m s/rad: c while the contact sticks, cs while it slides
  double anchor{0.0};         ///< elongation xr of the reversal at which the spring's branch starts, rad
  double anchor_torque{0.0};  ///< spring torque σr at the start of the branch, N m
  /// Direction: side of xr on which the branch lies; while the contact slides, the direction of the slide.
  double sign{1.0};
  double k1{0.0};  ///< stiffness k1 of the spring's linear part, N m/rad
  /// Torque of the softening part of the spring, N m; while the contact slides: Fs − Fc of the Stribeck
  /// curve.
  double softening_torque{0.0};
  /// Rate of the softening, 1/rad; while the contact slides: 1/(ωs·τ) of the Stribeck curve.
  double softening_rate{0.0};
  double coulomb{0.0};     ///< Coulomb friction torque Fc, N m
  double alpha{0.0};       ///< rate α of creep, 1/s; 0 while the contact does not creep
  double per_lambda{0.0};  ///< factor 1/λ of the creep law, rad/(N m)ⁿ
  double n{2.0};           ///< exponent of the torque in the creep law
  double side{1.0};        ///< sign of the spring torque σ while the contact creeps
  bool sliding{false};
  /// exp(−softening_rate·travel) at the state for which the spring torque was last computed. If the last
  /// stage of the integration method is the end of its step, that is the end of the step.
  mutable double softness{1.0};

  /// Computes the slope dy/dt of the state.
  void operator()(const PeerState& y, PeerState& slope, double /*time*/) const {
    const double omega = y[1] * per_tau;
    if (sliding) {
      const double w = y[1] * softening_rate;
      const double level = coulomb + softening_torque * std::exp(-w * w);
      slope = {omega, (torque - damping * omega - sign * level) * tau_per_inertia, 0.0};
      return;
    }
    const double sigma = spring_torque(y[0]);
    const double growth = alpha != 0.0 ? alpha * (hardening_limit(sigma) - y[2]) : 0.0;
    slope = {omega - side * growth, (torque - damping * omega - sigma) * tau_per_inertia, growth};
  }

  /// Spring torque σ (N m) at the elongation x (rad).
  double spring_torque(double x) const {
    const double travel = sign * (x - anchor);
    softness = std::exp(-softening_rate * travel);
    return anchor_torque + sign * (k1 * travel + softening_torque * (1.0 - softness));
  }

  /// Hardening |σ|ⁿ/λ (rad) at which creep under the spring torque σ ends.
  double hardening_limit(double sigma) const {
    return (n == 2.0 ? sigma * sigma : std::pow(std::abs(sigma), n)) * per_lambda;
  }

  /// Stiffness dσ/dx (N m/rad) of the spring where `softness` (see the member) has this value.
  double stiffness(double softness_there) const {
    return k1 + softening_torque * softening_rate * softness_there;
  }
};

}  // namespace zerocount::testing
