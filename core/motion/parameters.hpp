#pragma once

namespace zerocount::motion {

/// The mass whose angle the encoders read.
enum class EncoderPlace { motor, load };

/// A second mass behind an elastic coupling. Defaults except the inertia are assumed.
struct LoadParameters {
  double inertia{0.0};      ///< JL, kg m²; 0: without a second mass
  double stiffness{2.0e4};  ///< kL of the coupling, N m/rad
  double damping{0.1};      ///< dL of the coupling, N m s/rad
  EncoderPlace encoder{EncoderPlace::motor};
  double gap{0.0};                ///< g, whole play of the coupling, rad
  double damping_to_ground{0.0};  ///< cg, of the load, N m s/rad
};

/// The rotor. J and c by default: the paper's (section 4); the sliding damping is assumed.
struct PlantParameters {
  double inertia{5.54e-4};         ///< J, kg m²
  double presliding_damping{0.2};  ///< c, from hook to rotor while the hook sticks, N m s/rad
  double sliding_damping{1.0e-3};  ///< cs, while the hook slides, N m s/rad
  LoadParameters load{};
};

inline bool has_load(const PlantParameters& plant) {
  return plant.load.inertia > 0.0;
}

}  // namespace zerocount::motion
