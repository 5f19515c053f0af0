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
  double torque{0.0};            ///< u, N m
  double per_tau{1.0};           ///< 1/τ, 1/s
  double tau_per_inertia{0.0};   ///< τ/J, 1/(N m s)
  double damping{0.0};           ///< c while the hook sticks, cs while it slides, N m s/rad
  double anchor{0.0};            ///< xr, where the branch starts, rad
  double anchor_torque{0.0};     ///< σr, N m
  double sign{1.0};              ///< side of xr on which the branch lies; direction of the slide
  double k1{0.0};                ///< N m/rad
  double softening_torque{0.0};  ///< N m; of a slide: Fs − Fc
  double softening_rate{0.0};    ///< 1/rad; of a slide: 1/(ωs·τ)
  double coulomb{0.0};           ///< Fc, N m
  double alpha{0.0};             ///< 1/s; 0 while nothing creeps
  double per_lambda{0.0};        ///< 1/λ, rad/(N m)ⁿ
  double n{2.0};                 ///< exponent of the torque in the creep law
  double side{1.0};              ///< sgn σ while the contact creeps
  bool sliding{false};
  /// exp(−softening_rate·travel) where the law was last asked for σ. After a step of a method whose last
  /// stage is the step's end, that is the end.
  mutable double softness{1.0};

  /// dy/dt.
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

  /// σ (N m) at the elongation x (rad).
  double spring_torque(double x) const {
    const double travel = sign * (x - anchor);
    softness = std::exp(-softening_rate * travel);
    return anchor_torque + sign * (k1 * travel + softening_torque * (1.0 - softness));
  }

  /// |σ|ⁿ/λ, rad.
  double hardening_limit(double sigma) const {
    return (n == 2.0 ? sigma * sigma : std::pow(std::abs(sigma), n)) * per_lambda;
  }

  /// dσ/dx (N m/rad) where the softness is this.
  double stiffness(double softness_there) const {
    return k1 + softening_torque * softening_rate * softness_there;
  }
};

}  // namespace zerocount::testing
