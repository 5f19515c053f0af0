#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace zerocount::parameters {

/// A parameter of the table that follows from measured ones.
struct FollowingParameter {
  std::string_view name;                          ///< dotted path
  std::vector<std::string_view> from;             ///< dotted paths of measured parameters
  double (*value)(std::span<const double> from);  ///< monotonic in each of them
};

/// Parameters that say by what one measures what others say by the constants of a law. A study that gives one
/// of them gives all of them, and none of those that follow.
struct MeasuredParameters {
  std::string_view section;             ///< dotted path of the map with their keys
  std::vector<std::string_view> names;  ///< dotted paths
  std::vector<FollowingParameter> following;
};

/// All of them:
///   friction.measured.creep {torque τ, extension x, rate, exponent}: α = rate, n = exponent, λ = τⁿ/x, with
///   which creep under the torque τ ends at the extension x.
std::span<const MeasuredParameters> measured_parameters();

/// Whether the parameter is a measured one.
bool is_measured(std::string_view name);

}  // namespace zerocount::parameters
