#pragma once

#include <string_view>
#include <vector>

#include "core/friction/parameters.hpp"
#include "core/motion/parameters.hpp"

namespace zerocount::friction {

/// A contact that does not change: a spring and a damper, or the damper alone.
struct LinearContact {
  std::string_view name;
  double stiffness;    ///< N m/rad
  double damping;      ///< N m s/rad
  bool slides{false};  ///< The contact yields, so that it has no stiffness.
};

/// The contacts that approximate a law, from the softest to the stiffest before it slides, and while it
/// slides.
using LinearContacts = std::vector<LinearContact>;

/// The stiffest contact before sliding. If there is none, a contact without stiffness and damping.
inline LinearContact stiffest_of(const LinearContacts& contacts) {
  LinearContact stiffest{"", 0.0, 0.0};
  for (const LinearContact& contact : contacts)
    if (contact.stiffness > stiffest.stiffness) stiffest = contact;
  return stiffest;
}

/// The contact of a sliding hook: the damping cs alone.
inline LinearContact sliding_contact(const motion::PlantParameters& plant) {
  return {"while sliding", 0.0, plant.sliding_damping, true};
}

/// The linear contacts of a hysteretic spring.
inline LinearContacts contacts_of_spring(const motion::PlantParameters& plant, const FrictionAlongRotor&,
                                         const FrictionParameters& contact) {
  const double damping = plant.presliding_damping;
  return {{"at k1", contact.k1, damping},
          {"at k1 + k2", contact.k1 + contact.k2, damping},
          sliding_contact(plant)};
}

}  // namespace zerocount::friction
