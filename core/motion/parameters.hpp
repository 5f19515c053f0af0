#pragma once

#include <vector>

namespace zerocount::motion {

/// The plant at t = 0, where θ = 0.
struct PlantStart {
  double position{0.0};   ///< Position on the friction profiles at θ = 0, rad
  double hardening{0.0};  ///< xh of the contact, rad
  double preload{0.0};    ///< Torque of a slow load-and-unload from virgin before t = 0, without creep, N m
  /// Torques (N m) reached slowly and without creep after the preload, in this order; then the torque returns
  /// to 0. Their absolute values are below the breakaway torque.
  std::vector<double> history{};
  double velocity{0.0};  ///< ω, rad/s
  /// Arrival from sliding: if velocity ≠ 0 the hook slides, and the spring had the breakaway torque when the
  /// slide began. Hardening, preload, history and holding then have no effect. A Coulomb contact slides
  /// whenever velocity ≠ 0, also without this.
  bool sliding{false};
  /// Torque (N m) to which the virgin contact has been loaded slowly and without creep, and which it carries
  /// at t = 0. It excludes a preload and a history.
  double holding{0.0};
};

/// The mass whose angle the encoders read.
enum class EncoderPlace { motor, load };  // also one of the two masses

/// A second mass behind an elastic coupling. Defaults except the inertia are assumed.
struct LoadParameters {
  double inertia{0.0};      ///< JL, kg m²; 0: without a second mass
  double stiffness{2.0e4};  ///< kL of the coupling, N m/rad
  double damping{0.1};      ///< dL of the coupling, N m s/rad
  EncoderPlace encoder{EncoderPlace::motor};
  double gap{0.0};                ///< g, whole play of the coupling, rad
  double damping_to_ground{0.0};  ///< Viscous damping cg between load and frame, N m s/rad
};

/// The rotor. J and c default to the paper's values (section 4); the sliding damping is assumed.
struct PlantParameters {
  double inertia{5.54e-4};         ///< J, kg m²
  double presliding_damping{0.2};  ///< Damping c between hook and rotor while the hook sticks, N m s/rad
  double sliding_damping{1.0e-3};  ///< Damping cs while the hook slides, N m s/rad
  LoadParameters load{};
};

inline bool has_load(const PlantParameters& plant) {
  return plant.load.inertia > 0.0;
}

}  // namespace zerocount::motion
