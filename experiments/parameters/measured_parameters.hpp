#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace zerocount::parameters {

/// Values of measured parameters. The function or member that uses them states their order.
using MeasuredNumbers = std::span<const double>;

/// A parameter of the friction law that is computed from measured parameters, such as k1 from a measured
/// stiffness.
struct DerivedParameter {
  std::string_view name;               ///< dotted path of the computed parameter
  std::vector<std::string_view> from;  ///< dotted paths of the measured parameters from which it is computed
  /// Computes the value from the values of `from`, in that order; NaN if no machine has these measured
  /// values. Null: the value equals its only source.
  double (*value)(MeasuredNumbers from){nullptr};
};

/// A condition low < high between measured values. If it is violated, no machine has these values.
struct MeasuredCondition {
  /// Formula of the lower side for messages, in the last keys of the paths: "breakaway/breakaway_travel".
  std::string_view low;
  std::string_view high;  ///< formula of the higher side for messages, in the same notation as `low`
  std::string_view unit;  ///< unit of both sides of the condition on a rotary axis
  /// Computes the lower side `low` from the values of the whole group.
  double (*low_value)(MeasuredNumbers values);
  /// Computes the upper side `high` from the values of the whole group.
  double (*high_value)(MeasuredNumbers values);
};

/// A group of measured parameters, such as a stiffness, from which the constants of a law follow. A study
/// that gives one parameter of the group must give all of them, and none of the parameters that follow.
struct MeasuredParameters {
  std::string_view section;  ///< dotted path of the map in a manifest that holds the measured parameters
  std::vector<std::string_view> names;  ///< dotted paths of all measured parameters of the group
  /// Number of leading `names` that only this group has. A manifest that gives one of them uses this group;
  /// the other names may belong to another group of the section.
  std::size_t own{0};
  std::vector<DerivedParameter> derived;
  /// Conditions between the measured values, all of which must hold.
  std::vector<MeasuredCondition> conditions{};
};

/// All groups of measured parameters. A study gives at most one group of each section:
///   friction.measured {initial_stiffness, final_stiffness, breakaway, breakaway_travel}, or
///   friction.measured {secant_stiffness, secant_travel, final_stiffness, breakaway, breakaway_travel}: the
///     spring whose virgin curve reaches breakaway after that travel (core/friction/presliding/
///     presliding/spring.hpp);
///   friction.measured.creep {torque τ, extension x, rate, exponent}: α = rate, n = exponent, λ = τⁿ/x, with
///     which creep under the torque τ ends at the extension x.
std::span<const MeasuredParameters> measured_parameters();

/// Whether the name is the dotted path of a measured parameter, such as a stiffness, from which constants of
/// a friction law follow.
bool is_measured(std::string_view name);

}  // namespace zerocount::parameters
