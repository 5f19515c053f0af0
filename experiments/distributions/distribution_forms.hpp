#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/distributions/distribution.hpp"
#include "experiments/distributions/random_field.hpp"
#include "experiments/shapes/shape.hpp"

namespace zerocount::distributions {

/// Name of the form of a value with two ends and no distribution. The values are spread evenly over the
/// worlds.
inline constexpr std::string_view interval_name = "interval";

/// One distribution in a manifest: a map with the single key `name`.
struct DistributionForm {
  std::string_view name;
  shapes::Shape shape;  ///< shape of the key's value: a list or a map of numbers
  std::string_view meaning;
  Distribution (*make)(const std::vector<double>& numbers){nullptr};
  bool whole_numbers{false};  ///< parameters and draws are whole numbers
};

/// Text for the value of the key in help texts: "[low, high]".
std::string shown_value(const DistributionForm& form);

/// All distributions, except `profile`.
std::span<const DistributionForm> distribution_forms();

/// The names, "uniform, log_uniform, …", for messages.
std::string distribution_names();

/// The distribution in `field`, the value of the key `form.name`. Empty after errors, such as low above high,
/// which are reported.
std::optional<Distribution> read_distribution(const DistributionForm& form, const yaml::Field& field,
                                              yaml::Problems& problems);

/// The form that `entry` of the map names. Reports an unknown name, with the nearest name among the forms and
/// `others`, and returns null.
const DistributionForm* find_form(const yaml::Field& map, const yaml::YamlEntry& entry,
                                  const std::vector<std::string>& others, std::string_view expected,
                                  yaml::Problems& problems);

/// A profile in a manifest: {mean, cv, correlation_length, marginal}; the default marginal is lognormal. The
/// mean is a number, or a distribution that is drawn for every rotor.
struct ProfileForm {
  ProfileDescription description;    ///< with mean 1 if the mean is drawn
  std::optional<Distribution> mean;  ///< set if the mean is drawn
};

/// The form of the value of the key `profile`.
const shapes::Shape& profile_shape();

/// Reads the value of the key `profile`. Empty after errors, which are reported.
/// @param period period of the random field, rad or m
std::optional<ProfileForm> read_profile(const yaml::Field& field, double period, yaml::Problems& problems);

}  // namespace zerocount::distributions
