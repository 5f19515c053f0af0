#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/distributions/distribution.hpp"
#include "experiments/distributions/distribution_forms.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/grouping.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount::keys {

/// The key beside a distribution or profile that specifies how often it is drawn.
constexpr std::string_view per_key = "per";

/// The values of the key `per`, in the order of the enumeration DrawLevel.
inline constexpr std::array<std::string_view, 5> draw_level_labels{"study", "world", "machine", "trial",
                                                                   "contact"};

/// The values of the key `per` that are allowed for a profile.
inline constexpr std::array<std::string_view, 2> draw_level_labels_of_profiles{"study", "machine"};

/// The kinds of groups of trials that a study has.
struct TrialGroups {
  bool machines{false};
  bool worlds{false};
  bool ages{false};
};

/// Kind of draw: a single value, or a profile along the rotor.
enum class Drawn {
  value,
  profile,
  interval  ///< a value without a distribution
};

/// Default of the key `per`. With machines, parameters of the machine are drawn for every machine and others
/// for every trial. Without machines, values are drawn for every trial and profiles once for the study.
/// Intervals are drawn for every world.
study::DrawLevel usual_level(const parameters::Parameter& parameter, Drawn drawn, const TrialGroups& groups);

/// The value of the key `per` in `field`. Empty for an unknown value, or one that the parameter does not
/// allow; both are reported.
std::optional<study::DrawLevel> read_draw_level(const yaml::Field& field,
                                                const parameters::Parameter& parameter, Drawn drawn,
                                                const TrialGroups& groups, yaml::Problems& problems);

// Texts of messages about the value of a parameter: what was expected in its place.

/// Text of the unit, ", in kg m^2"; empty if the parameter is dimensionless.
std::string unit_text(const parameters::Parameter& parameter, const parameters::StudyUnits& units);

/// Text after the range of a number: ", in kg m^2, or a distribution, such as {uniform: [0.00044, 0.00066]}".
/// The numbers of the example lie around the default, if there is one.
std::string number_alternatives(const parameters::Parameter& parameter, const parameters::StudyUnits& units);

/// The values that a distribution may have: "numbers greater than 0 only, in N m/rad"; or the labels.
std::string allowed_values(const parameters::Parameter& parameter, const parameters::StudyUnits& units);

/// Suggestion for a normal distribution that leaves the range of its parameter: the nearest bounded
/// distributions,
/// ": {truncated_normal: {mean: 110, sd: 15, low: 65, high: 155}} or {lognormal: {median: 110, cv: 0.136}}".
/// Empty for other distributions, and if only whole numbers are allowed.
std::string cure_of_normal(const distributions::Distribution& distribution,
                           const parameters::Parameter& parameter);

/// A friction parameter that varies along the axis, as the manifest describes it. Its values are drawn when
/// the seed is known.
struct ProfileRequest {
  std::size_t slot{0};  ///< slot of the parameter in the plan
  distributions::ProfileForm form;
  /// One profile for all trials (study), or one for each machine.
  study::DrawLevel level{study::DrawLevel::study};
  yaml::Place place;  ///< place of the profile in the manifest, for messages
  std::string path;
};

/// The data that reading a manifest produces.
struct Reading {
  yaml::Problems& problems;
  study::StudyPlan& plan;  ///< plan that is filled, for example with the distributions
  study::Study& study;
  bool recorded{false};       ///< the study has results: a target the encoder does not see is only a warning
  TrialGroups groups{};       ///< kinds of groups that the study has
  bool plugin_failed{false};  ///< the user's controller could not be loaded
  std::vector<ProfileRequest> profiles{};  ///< [Value::index of a profile] profile to be realised
  std::vector<std::string> warnings{};     ///< messages about allowed but possibly unintended values
  /// Assignment to the rate's slot, set if the value read last changes with age. The code that takes this
  /// value must take the rate as well, and reset it.
  std::optional<study::Assignment> rate{};
};

/// Places of a plan's values in the manifest.
struct PlanPlaces {
  std::vector<yaml::Place> base;               ///< [slot]; for a default the manifest's first line
  std::vector<bool> written;                   ///< [slot] whether the base value is written in the manifest
  std::vector<std::vector<yaml::Place>> axes;  ///< [axis][assignment]
  yaml::Place record{};                        ///< place of command.torque.file or command.reference.file
};

/// Reports realised profiles that leave the range of their parameter somewhere on a rotor.
void check_profiles(const Reading& reading);

/// Represents a value that could not be read: NaN, so that later checks ignore it.
study::Value unreadable_value();

/// The value of the parameter of the slot: a number, a label, a distribution or a profile, checked against
/// the parameter's range. Reports errors and returns unreadable_value() then. Sets or resets Reading::rate.
study::Value read_value(const yaml::Field& field, std::size_t slot, Reading& reading);

/// `number` as a value of the parameter, checked as read_value() does; `field` is its source.
study::Value checked_number(const yaml::Field& field, std::size_t slot, double number, Reading& reading);

inline constexpr std::string_view aging_key = "aging";
/// The key of a value that is a plain number, if it is given together with `aging`: {value: 3, aging: ...}.
inline constexpr std::string_view value_key = "value";

/// Reads the key `aging` of the value of a slot: {exponential: -0.1, scale: 1.0e+6}. Adds the slot of the
/// rate to the plan, stores the law in `value`, and the value of the rate in Reading::rate. Reports errors.
/// @param field field of the key `aging`
void read_aging(const yaml::Field& field, std::size_t slot, study::Value& value, Reading& reading);

}  // namespace zerocount::keys
