#pragma once

namespace zerocount::motion {

/// The rotor. J and c by default: the paper's (section 4); the sliding damping is assumed.
struct PlantParameters {
  double inertia{5.54e-4};         ///< J, kg m²
  double presliding_damping{0.2};  ///< c, from hook to rotor while the hook sticks, N m s/rad
  double sliding_damping{1.0e-3};  ///< cs, while the hook slides, N m s/rad
};

}  // namespace zerocount::motion
