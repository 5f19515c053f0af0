#pragma once

#include <array>

#include "core/friction/bristles/bristle.hpp"

namespace zerocount::friction {

/// The law of Dahl (1968), with a viscous damping c:
///
///   dz/dt = ω − σ0·|ω|·z/Fc,   F = σ0·z + c·ω,   Fc = coulomb_ratio·breakaway.
class DahlFriction : public Bristle {
 public:
  static constexpr std::string_view word = "dahl";
  static constexpr std::array<ContactField, 3> contact_parameters{
      &FrictionParameters::breakaway, &FrictionParameters::coulomb_ratio, &FrictionParameters::sigma0};
  static constexpr bool has_presliding_damping = true;
  static constexpr bool has_sliding_damping = false;

  static LinearContacts linear_contacts(const motion::PlantParameters& plant, const FrictionAlongRotor&,
                                        const FrictionParameters& contact) {
    return {{"at sigma0", contact.sigma0, plant.presliding_damping},
            {"while sliding", 0.0, plant.presliding_damping, true}};
  }
  static BristleParameters bristle(const motion::PlantParameters& plant, const FrictionParameters& contact) {
    return bristle_parameters(contact.sigma0, 0.0, plant.presliding_damping,
                              {stribeck_curve(contact).coulomb, 0.0, 0.0});
  }

  /// The parameters are those at the start, wherever the rotor goes.
  DahlFriction(const motion::PlantParameters& plant, const FrictionAlongRotor& friction,
               const motion::PlantStart& start, const motion::MotionTolerance& tolerance)
      : Bristle(bristle(plant, friction_at(friction, start.position)), plant.inertia, start, tolerance) {}
};

}  // namespace zerocount::friction
