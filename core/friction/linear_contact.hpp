#pragma once

#include <string_view>
#include <vector>

#include "core/friction/parameters.hpp"
#include "core/motion/parameters.hpp"

namespace zerocount::friction {

/// Linear approximation of a friction contact: a spring and a damper in parallel, or the damper alone.
struct LinearContact {
  std::string_view name;
  double stiffness;    ///< Stiffness of the spring, N m/rad
  double damping;      ///< Viscous damping, N m s/rad
  bool slides{false};  ///< Whether the contact slides, so that it has no stiffness
};

/// Linear contacts that approximate a friction law: first those before it slides, from the softest to the
/// stiffest, then the one while it slides.
using LinearContacts = std::vector<LinearContact>;

/// The stiffest of the linear contacts that do not slide. If there is none, a contact without stiffness and
/// damping.
inline LinearContact stiffest_of(const LinearContacts& contacts) {
  LinearContact stiffest{"", 0.0, 0.0};
  for (const LinearContact& contact : contacts)
    if (contact.stiffness > stiffest.stiffness) stiffest = contact;
  return stiffest;
}

/// The linear approximation of a contact that slides: no stiffness, and the damping cs.
inline LinearContact sliding_contact(const motion::PlantParameters& plant) {
  return {"while sliding", 0.0, plant.sliding_damping, true};
}

/// The linear contacts that approximate a hysteretic spring: with its lowest stiffness k1, with its highest
/// k1 + k2, and while it slides.
inline LinearContacts contacts_of_spring(const motion::PlantParameters& plant, const FrictionAlongRotor&,
                                         const FrictionParameters& contact) {
  const double damping = plant.presliding_damping;
  return {{"at k1", contact.k1, damping},
          {"at k1 + k2", contact.k1 + contact.k2, damping},
          sliding_contact(plant)};
}

}  // namespace zerocount::friction
