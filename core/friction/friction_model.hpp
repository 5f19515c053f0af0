#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace zerocount::friction {

struct LawTraits;

/// Friction model between rotor and bearing. Each value selects a law of FrictionLaws (laws.hpp), in the same
/// order.
enum class FrictionModel {
  presliding,  ///< Paper's model: hysteretic spring with creep before sliding (PreslidingFriction)
  spring,      ///< Hysteretic spring without creep before sliding (SpringFriction)
  coulomb,     ///< Coulomb friction with a static level (CoulombFriction)
  none,        ///< No dry friction, an air bearing (NoFriction)
  dahl,        ///< Bristle law of Dahl (DahlFriction)
  lugre,       ///< LuGre law, a bristle with damping (LuGreFriction)
  gms          ///< Generalised Maxwell-slip model (GmsFriction)
};

/// Properties of a friction law that do not depend on its state.
const LawTraits& traits_of(FrictionModel model);

/// The properties of all friction laws, in the order of FrictionModel.
std::span<const LawTraits> all_traits();

/// Texts that select a friction model in a manifest (key friction.model), in the order of FrictionModel.
std::vector<std::string_view> friction_model_labels();

// Derived from the contact parameters that the law uses:

/// Whether the model has any dry friction.
bool has_friction(FrictionModel model);

/// Largest torque (N m) that the contact holds at rest: its breakaway torque or, for the bristle of dahl, the
/// Coulomb level at which it yields. 0 without friction.
double holding_limit(FrictionModel model, double breakaway, double coulomb_ratio);

/// Whether the contact acts as a hysteretic spring (k1) before it slides. Criteria (6) and (7) of the paper
/// apply to such contacts.
bool has_spring(FrictionModel model);

/// Whether the contact creeps, under constant torque, before it slides.
bool has_creep(FrictionModel model);

}  // namespace zerocount::friction
