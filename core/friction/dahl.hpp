#pragma once

#include <array>

#include "core/friction/bristle.hpp"

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

  /// The parameters are those at the start, wherever the rotor goes.
  DahlFriction(const motion::PlantParameters& plant, const FrictionAlongRotor& friction,
               const motion::PlantStart& start, const motion::MotionTolerance& tolerance)
      : Bristle(constants(plant, friction_at(friction, start.position)), plant.inertia, start, tolerance) {}

 private:
  static BristleParameters constants(const motion::PlantParameters& plant,
                                     const FrictionParameters& contact) {
    return bristle_parameters(contact.sigma0, 0.0, plant.presliding_damping,
                              {stribeck_curve(contact).coulomb, 0.0, 0.0});
  }
};

}  // namespace zerocount::friction
