#pragma once

#include <optional>

#include "experiments/distributions/distribution.hpp"
#include "experiments/distributions/random_field.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount {

/// A profile as a manifest writes it: {mean, cv, correlation_length, marginal}, marginal lognormal if left
/// out. The mean is a number, or a distribution from which every rotor has its own.
struct ProfileForm {
  ProfileDescription description;    ///< its mean: 1 where it is drawn
  std::optional<Distribution> mean;  ///< where it is drawn
};

/// The value of the key `profile`. Reports what is wrong, and returns nothing then.
/// @param period of the field, rad or m.
std::optional<ProfileForm> read_profile(const Field& field, double period, Problems& problems);

}  // namespace zerocount
