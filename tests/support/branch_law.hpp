#pragma once

#include <cmath>

#include "core/friction/parameters.hpp"

namespace zerocount::testing {

/// Torque gained (N m) along a branch of the friction spring after the travel u ≥ 0 (rad), from its
/// definition: f(u) = k1·u + (k2/β)·(1 − exp(−βu)), β > 0.
inline double branch_law(const friction::FrictionParameters& contact, double travel) {
  return contact.k1 * travel - contact.k2 / contact.beta * std::expm1(-contact.beta * travel);
}

}  // namespace zerocount::testing
