#pragma once

#include <optional>

#include "experiments/distributions/distribution.hpp"
#include "experiments/distributions/random_field.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount::distributions {

/// A profile in a manifest: {mean, cv, correlation_length, marginal}; the default marginal is lognormal. The
/// mean is a number, or a distribution that is drawn for every rotor.
struct ProfileForm {
  ProfileDescription description;    ///< with mean 1 if the mean is drawn
  std::optional<Distribution> mean;  ///< set if the mean is drawn
};

/// The value of the key `profile`. Reports errors and returns nothing then.
/// @param period of the field, rad or m.
std::optional<ProfileForm> read_profile(const yaml::Field& field, double period, yaml::Problems& problems);

}  // namespace zerocount::distributions
