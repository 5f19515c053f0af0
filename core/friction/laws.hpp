#pragma once

#include <variant>

#include "core/friction/coulomb.hpp"
#include "core/friction/dahl.hpp"
#include "core/friction/gms.hpp"
#include "core/friction/lugre.hpp"
#include "core/friction/none.hpp"
#include "core/friction/presliding.hpp"

namespace zerocount::friction {

template <FrictionLaw... Laws>
struct LawList {
  template <template <class> class Of>
  using Variant = std::variant<Of<Laws>...>;  ///< for instance of a plant with each law
  static constexpr std::array traits{traits_of<Laws>()...};
};

/// All laws, in the order of FrictionModel.
using FrictionLaws = LawList<PreslidingFriction, SpringFriction, CoulombFriction, NoFriction, DahlFriction,
                             LuGreFriction, GmsFriction>;

}  // namespace zerocount::friction
