#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace zerocount::parameters {

/// Numbers of measured parameters, in an order that is given with them.
using MeasuredNumbers = std::span<const double>;

/// A parameter of the table that follows from measured ones.
struct FollowingParameter {
  std::string_view name;               ///< dotted path
  std::vector<std::string_view> from;  ///< dotted paths of measured parameters
  /// NaN where the measured values are those of no machine; null: the same number as its only source.
  double (*value)(MeasuredNumbers from){nullptr};
};

/// A condition of measured values without which nothing follows from them: low < high.
struct MeasuredCondition {
  std::string_view low;   ///< formula of the last keys of parameters: "breakaway/breakaway_travel"
  std::string_view high;  ///< likewise
  std::string_view unit;  ///< of both, on a rotary axis
  double (*low_value)(MeasuredNumbers values);  ///< of all values of the group
  double (*high_value)(MeasuredNumbers values);
};

/// Parameters that say by what one measures what others say by the constants of a law. A study that gives one
/// of them gives all of them, and none of those that follow.
struct MeasuredParameters {
  std::string_view section;             ///< dotted path of the map with their keys
  std::vector<std::string_view> names;  ///< dotted paths
  /// The first of them, without which other keys of the section stand for another group: how many.
  std::size_t own{0};
  std::vector<FollowingParameter> following;
  std::vector<MeasuredCondition> conditions{};  ///< all must hold
};

/// All of them; of the groups of one section a study gives one.
///   friction.measured {initial_stiffness, final_stiffness, breakaway, breakaway_travel}, or
///   friction.measured {secant_stiffness, secant_travel, final_stiffness, breakaway, breakaway_travel}: the
///     spring whose virgin curve reaches breakaway after that travel (core/friction/presliding/
///     presliding/spring.hpp);
///   friction.measured.creep {torque τ, extension x, rate, exponent}: α = rate, n = exponent, λ = τⁿ/x, with
///     which creep under the torque τ ends at the extension x.
std::span<const MeasuredParameters> measured_parameters();

/// Whether the parameter is a measured one.
bool is_measured(std::string_view name);

}  // namespace zerocount::parameters
