#pragma once

#include <vector>

namespace zerocount::motion {

/// Initial state of the plant, at t = 0, where the rotor angle is θ = 0.
struct PlantStart {
  double position{0.0};   ///< Position on the friction profiles that belongs to θ = 0, rad
  double hardening{0.0};  ///< Hardening xh of the contact, rad
  double preload{0.0};    ///< Largest torque of a slow loading and unloading before t = 0, from the virgin
                          ///< state and without creep, N m
  /// Torques (N m) that the contact has been loaded to, slowly and without creep, after the preload and in
  /// this order; then the torque returns to 0. Their absolute values are below the breakaway torque.
  std::vector<double> history{};
  double velocity{0.0};  ///< Velocity ω of the rotor, rad/s
  /// Whether the rotor arrives sliding: if velocity ≠ 0 the friction contact slides at t = 0, and the spring
  /// had the breakaway torque when the slide began. Hardening, preload, history and holding then have no
  /// effect. A Coulomb contact slides whenever velocity ≠ 0, also if this is false.
  bool sliding{false};
  /// Torque (N m) to which the virgin contact has been loaded slowly and without creep, and which it carries
  /// at t = 0. It excludes a preload and a history.
  double holding{0.0};
};

/// Selects one of the two masses, the motor's rotor or the load; as a parameter of the plant, the mass whose
/// angle the encoders read.
enum class EncoderPlace { motor, load };  // also one of the two masses

/// Parameters of a second mass behind an elastic coupling. Defaults except the inertia are assumed.
struct LoadParameters {
  double inertia{0.0};      ///< Inertia JL of the second mass, kg m²; 0: there is no second mass
  double stiffness{2.0e4};  ///< Stiffness kL of the coupling, N m/rad
  double damping{0.1};      ///< Damping dL of the coupling, N m s/rad
  EncoderPlace encoder{EncoderPlace::motor};
  double gap{0.0};                ///< Gap g, the whole play of the coupling, rad
  double damping_to_ground{0.0};  ///< Viscous damping cg between the second mass and the frame, N m s/rad
};

/// Parameters of the rotor. J and c default to the paper's values (section 4); the sliding damping is
/// assumed.
struct PlantParameters {
  double inertia{5.54e-4};         ///< Inertia J of the rotor, kg m²
  double presliding_damping{0.2};  ///< Damping c between the rotor and the end of the friction spring (hook)
                                   ///< while the contact sticks, N m s/rad
  double sliding_damping{1.0e-3};  ///< Viscous damping cs while the friction contact slides, N m s/rad
  LoadParameters load{};
};

inline bool has_load(const PlantParameters& plant) {
  return plant.load.inertia > 0.0;
}

}  // namespace zerocount::motion
