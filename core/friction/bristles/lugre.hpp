#pragma once

#include <array>

#include "core/friction/bristles/bristle.hpp"

namespace zerocount::friction {

/// The LuGre law (Canudas de Wit, Olsson, Åström and Lischinsky, "A new model for control of systems with
/// friction", IEEE Trans. Automatic Control 40, 1995):
///
///   dz/dt = ω − σ0·|ω|·z/g(ω),   F = σ0·z + σ1·dz/dt + cs·ω,   with g of StribeckCurve.
class LuGreFriction : public Bristle {
 public:
  static constexpr std::string_view word = "lugre";
  static constexpr std::array<ContactField, 5> contact_parameters{
      &FrictionParameters::breakaway, &FrictionParameters::coulomb_ratio,
      &FrictionParameters::stribeck_velocity, &FrictionParameters::sigma0, &FrictionParameters::sigma1};
  static constexpr bool has_presliding_damping = false;
  static constexpr bool has_sliding_damping = true;

  static LinearContacts linear_contacts(const motion::PlantParameters& plant, const FrictionAlongRotor&,
                                        const FrictionParameters& contact) {
    return {{"at sigma0", contact.sigma0, contact.sigma1 + plant.sliding_damping}, sliding_contact(plant)};
  }
  static BristleParameters bristle(const motion::PlantParameters& plant, const FrictionParameters& contact) {
    return bristle_parameters(contact.sigma0, contact.sigma1, plant.sliding_damping, stribeck_curve(contact));
  }

  /// The parameters are those at the start, wherever the rotor goes.
  LuGreFriction(const motion::PlantParameters& plant, const FrictionAlongRotor& friction,
                const motion::PlantStart& start, const motion::MotionTolerance& tolerance)
      : Bristle(bristle(plant, friction_at(friction, start.position)), plant.inertia, start, tolerance) {}
};

}  // namespace zerocount::friction
