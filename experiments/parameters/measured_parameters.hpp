#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace zerocount::parameters {

/// Numbers of measured parameters. The declaration that uses them states their order.
using MeasuredNumbers = std::span<const double>;

/// A parameter of the table that is computed from measured parameters.
struct DerivedParameter {
  std::string_view name;               ///< dotted path
  std::vector<std::string_view> from;  ///< dotted paths of measured parameters
  /// Computes the value from the sources; NaN if no machine has these measured values. Null: the value equals
  /// its only source.
  double (*value)(MeasuredNumbers from){nullptr};
};

/// A condition low < high between measured values. If it is violated, no machine has these values.
struct MeasuredCondition {
  std::string_view low;   ///< formula in the last keys of the paths, "breakaway/breakaway_travel"
  std::string_view high;  ///< formula of the upper side, in the same notation as `low`
  std::string_view unit;  ///< unit of both sides on a rotary axis
  double (*low_value)(MeasuredNumbers values);   ///< computes `low` from all values of the group
  double (*high_value)(MeasuredNumbers values);  ///< computes `high` from all values of the group
};

/// A group of measured parameters, such as a stiffness, from which the constants of a law follow. A study
/// that gives one parameter of the group must give all of them, and none of the parameters that follow.
struct MeasuredParameters {
  std::string_view section;             ///< dotted path of the map with their keys
  std::vector<std::string_view> names;  ///< dotted paths
  /// Number of leading `names` that only this group has. A manifest that gives one of them uses this group;
  /// the other names may belong to another group of the section.
  std::size_t own{0};
  std::vector<DerivedParameter> derived;
  std::vector<MeasuredCondition> conditions{};  ///< conditions of the values, all of which must hold
};

/// All groups of measured parameters. A study gives at most one group of each section:
///   friction.measured {initial_stiffness, final_stiffness, breakaway, breakaway_travel}, or
///   friction.measured {secant_stiffness, secant_travel, final_stiffness, breakaway, breakaway_travel}: the
///     spring whose virgin curve reaches breakaway after that travel (core/friction/presliding/
///     presliding/spring.hpp);
///   friction.measured.creep {torque τ, extension x, rate, exponent}: α = rate, n = exponent, λ = τⁿ/x, with
///     which creep under the torque τ ends at the extension x.
std::span<const MeasuredParameters> measured_parameters();

/// Whether a parameter belongs to a group of measured parameters.
/// @param name dotted path
bool is_measured(std::string_view name);

}  // namespace zerocount::parameters
