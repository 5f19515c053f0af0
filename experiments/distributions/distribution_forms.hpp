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

/// Name of the form in a manifest of a value with two ends and no distribution (an unknown value between
/// bounds). Its values are spread evenly over the worlds; a world is one possible set of the values that
/// nobody knows and all machines share.
inline constexpr std::string_view interval_name = "interval";

/// How one distribution is written in a manifest: as a map with the single key `name`.
struct DistributionForm {
  std::string_view name;
  shapes::Shape shape;  ///< shape of the key's value: a list or a map of numbers
  std::string_view meaning;
  Distribution (*make)(const std::vector<double>& numbers){nullptr};
  bool whole_numbers{false};  ///< the parameters and the drawn values are whole numbers
};

/// Text that shows in help texts how the value of the distribution's key is written: "[low, high]".
std::string shown_value(const DistributionForm& form);

/// The forms of all distributions that a manifest can have, except `profile`.
std::span<const DistributionForm> distribution_forms();

/// The names of all distributions in one text, "uniform, log_uniform, …", for messages.
std::string distribution_names();

/// Reads the distribution in `field`, the value of the key `form.name`. Empty after errors, such as low above
/// high, which are reported.
std::optional<Distribution> read_distribution(const DistributionForm& form, const yaml::Field& field,
                                              yaml::Problems& problems);

/// The distribution form whose name is the key of `entry` in the map. Reports an unknown name, with the
/// nearest name among the forms and `others`, and returns null.
const DistributionForm* find_form(const yaml::Field& map, const yaml::YamlEntry& entry,
                                  const std::vector<std::string>& others, std::string_view expected,
                                  yaml::Problems& problems);

/// A friction parameter that varies along the axis as a random field, as a manifest describes it: {mean, cv,
/// correlation_length, marginal}; the default marginal is lognormal. The mean is a number, or a distribution
/// that is drawn for every rotor.
struct ProfileForm {
  ProfileDescription description;    ///< description of the random field; its mean is 1 if the mean is drawn
  std::optional<Distribution> mean;  ///< distribution of the mean; empty if the mean is a fixed number
};

/// The allowed shape of the value of the manifest's key `profile`: a friction parameter that varies along the
/// axis.
const shapes::Shape& profile_shape();

/// Reads the value of the key `profile`: a friction parameter that varies along the axis. Empty after errors,
/// which are reported.
/// @param period period of the random field, rad or m
std::optional<ProfileForm> read_profile(const yaml::Field& field, double period, yaml::Problems& problems);

}  // namespace zerocount::distributions
