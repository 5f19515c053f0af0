#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace zerocount::friction {

struct LawTraits;

/// The friction between rotor and bearing: a law of FrictionLaws (laws.hpp), in the same order.
enum class FrictionModel {
  presliding,  ///< PreslidingFriction
  spring,      ///< SpringFriction
  coulomb,     ///< CoulombFriction
  none,        ///< NoFriction
  dahl,        ///< DahlFriction
  lugre,       ///< LuGreFriction
  gms          ///< GmsFriction
};

/// Properties of a law.
const LawTraits& traits_of(FrictionModel model);

/// The properties of all laws, in the order of FrictionModel.
std::span<const LawTraits> all_traits();

/// Values of friction.model in a manifest, in the order of FrictionModel.
std::vector<std::string_view> friction_model_labels();

// Derived from the contact parameters that the law uses:

/// Whether there is friction at all.
bool has_friction(FrictionModel model);

/// Torque (N m) below which the contact holds at rest: its breakaway torque, or the Coulomb level at which
/// the bristle of dahl yields. 0 without friction.
double holding_limit(FrictionModel model, double breakaway, double coulomb_ratio);

/// Whether the contact is a hysteretic spring (k1) before it slides, to which criteria (6) and (7) apply.
bool has_spring(FrictionModel model);

/// Whether the contact creeps before it slides.
bool has_creep(FrictionModel model);

}  // namespace zerocount::friction
