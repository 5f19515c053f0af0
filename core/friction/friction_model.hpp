#pragma once

namespace zerocount {

/// The friction between rotor and bearing.
enum class FrictionModel {
  presliding,  ///< hysteretic spring and creep (paper, section 2)
  spring,      ///< the hysteretic spring alone: creep is off, as with alpha 0 at every contact
  coulomb,     ///< Amonton–Coulomb with a static level: no displacement at all until |torque| exceeds the
               ///< breakaway, and then the sliding of the two above
  none         ///< an air bearing: a rotor with viscous damping, and no contact
};

/// Whether the contact is a spring before it slides.
bool has_spring(FrictionModel model);

/// Whether the contact creeps before it slides.
bool has_creep(FrictionModel model);

/// Whether the contact holds the rotor until a torque breaks it away.
bool has_breakaway(FrictionModel model);

}  // namespace zerocount
