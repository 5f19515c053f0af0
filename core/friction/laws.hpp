#pragma once

#include <variant>

#include "core/friction/bristles/bristle.hpp"
#include "core/friction/bristles/gms.hpp"
#include "core/friction/presliding/presliding.hpp"
#include "core/friction/sliding/coulomb.hpp"
#include "core/friction/sliding/none.hpp"

namespace zerocount::friction {

template <FrictionLaw... Laws>
struct LawList {
  template <template <class> class Of>
  /// A std::variant with one alternative for each friction law, for instance a plant with that law.
  using Variant = std::variant<Of<Laws>...>;
  static constexpr std::array traits{traits_of<Laws>()...};
};

/// All friction laws, in the order of FrictionModel.
using FrictionLaws = LawList<PreslidingFriction, SpringFriction, CoulombFriction, NoFriction, DahlFriction,
                             LuGreFriction, GmsFriction>;

}  // namespace zerocount::friction
