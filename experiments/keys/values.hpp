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

/// The key that is written beside a distribution or profile and specifies how often it is drawn.
constexpr std::string_view per_key = "per";

/// The values of the key `per` (how often a value is drawn), in the order of the enumeration DrawLevel.
inline constexpr std::array<std::string_view, 5> draw_level_labels{"study", "world", "machine", "trial",
                                                                   "contact"};

/// The values of the key `per` (how often it is drawn) that are allowed for a friction parameter that varies
/// along the axis (`profile`).
inline constexpr std::array<std::string_view, 2> draw_level_labels_of_profiles{"study", "machine"};

/// The kinds of groups into which the trials of a study are divided.
struct TrialGroups {
  bool machines{false};
  bool worlds{false};
  bool ages{false};
};

/// Kind of a drawn quantity: a single value, a profile along the rotor, or a value without a distribution.
enum class Drawn {
  value,
  profile,
  interval  ///< a value between two ends, without a distribution
};

/// Default of the key `per`, which says how often a value is drawn. With machines, parameters of the machine
/// are drawn for every machine and others for every trial. Without machines, values are drawn for every trial
/// and profiles once for the study. Intervals (values without a distribution) are drawn for every world, one
/// possible set of the values that nobody knows and all machines share.
study::DrawLevel usual_level(const parameters::Parameter& parameter, Drawn drawn, const TrialGroups& groups);

/// Reads the value of the key `per`: how often a value is drawn. Empty for an unknown value, or one that the
/// parameter does not allow; both are reported.
std::optional<study::DrawLevel> read_draw_level(const yaml::Field& field,
                                                const parameters::Parameter& parameter, Drawn drawn,
                                                const TrialGroups& groups, yaml::Problems& problems);

// Texts of messages about the value of a parameter: what was expected in its place.

/// Text of the parameter's unit for a message, ", in kg m^2"; empty if the parameter is dimensionless.
std::string unit_text(const parameters::Parameter& parameter, const parameters::StudyUnits& units);

/// Text that follows the allowed range in a message: ", in kg m^2, or a distribution, such as {uniform:
/// [0.00044, 0.00066]}". The numbers of the example lie around the default, if there is one.
std::string number_alternatives(const parameters::Parameter& parameter, const parameters::StudyUnits& units);

/// Text for a message: the values that a distribution of the parameter may have, "numbers greater than 0
/// only, in N m/rad"; or its labels.
std::string allowed_values(const parameters::Parameter& parameter, const parameters::StudyUnits& units);

/// Suggestion for a normal distribution that leaves the range of its parameter: the nearest bounded
/// distributions,
/// ": {truncated_normal: {mean: 110, sd: 15, low: 65, high: 155}} or {lognormal: {median: 110, cv: 0.136}}".
/// Empty for other distributions, and if only whole numbers are allowed.
std::string cure_of_normal(const distributions::Distribution& distribution,
                           const parameters::Parameter& parameter);

/// A friction parameter that varies along the axis as a random field, as the manifest describes it. The field
/// is drawn later, when the seed of the study is known.
struct ProfileRequest {
  std::size_t slot{0};  ///< index of the parameter in the plan of the study
  distributions::ProfileForm form;
  /// How often the random field is drawn: once for all trials (study), or once for each machine.
  study::DrawLevel level{study::DrawLevel::study};
  yaml::Place place;  ///< place of the profile in the manifest, for messages
  std::string path;
};

/// A study whose manifest is being read: the plan and the study that are filled, the problems and the
/// warnings.
struct StudyDraft {
  yaml::Problems& problems;
  study::StudyPlan& plan;  ///< plan of the study that is filled, for example with the distributions
  study::Study& study;
  bool recorded{false};       ///< the study has results: a target the encoder does not see is only a warning
  TrialGroups groups{};       ///< kinds of groups of trials (machines, worlds, ages) that the study has
  bool plugin_failed{false};  ///< the user's controller could not be loaded
  /// Friction parameters that vary along the axis, to be realised later; Value::index of a profile is its
  /// index here.
  std::vector<ProfileRequest> profiles{};
  std::vector<std::string> warnings{};  ///< messages about allowed but possibly unintended values
  /// Assignment to the slot of the rate of aging, set if the value that was read last changes with age. The
  /// code that takes this value must take the rate as well, and reset it.
  std::optional<study::Assignment> rate{};
};

/// Places in the manifest (line and column) of the values of a plan.
struct PlanPlaces {
  /// [slot of the plan] place of the value outside the sweep; for a default the manifest's first line.
  std::vector<yaml::Place> base;
  /// [slot of the plan] whether the value outside the sweep is written in the manifest.
  std::vector<bool> written;
  /// [axis of the plan][assignment of a value] place of this value.
  std::vector<std::vector<yaml::Place>> axes;
  yaml::Place record{};  ///< place of command.torque.file or command.reference.file
};

/// Reports friction parameters whose drawn profile along the axis leaves the range of the parameter at some
/// position of a rotor.
void check_profiles(const StudyDraft& draft);

/// A value that stands for one that could not be read: the number NaN, so that later checks ignore it.
study::Value unreadable_value();

/// Reads the value of the parameter with this slot (index in the plan): a number, a label, a distribution or
/// a profile, checked against the parameter's range. Reports errors and returns unreadable_value() then. Sets
/// or resets StudyDraft::rate.
study::Value read_value(const yaml::Field& field, std::size_t slot, StudyDraft& draft);

/// `number` as a value of the parameter with this slot (index in the plan), checked as read_value() does;
/// `field` is the place for messages.
study::Value checked_number(const yaml::Field& field, std::size_t slot, double number, StudyDraft& draft);

inline constexpr std::string_view aging_key = "aging";
/// The key under which a plain number stands if the law of aging is given beside it: {value: 3, aging: ...}.
inline constexpr std::string_view value_key = "value";

/// Reads the key `aging` of the value of a slot: {exponential: -0.1, scale: 1.0e+6}. Adds the slot of the
/// rate to the plan, stores the law in `value`, and the value of the rate in StudyDraft::rate. Reports
/// errors.
/// @param field field of the key `aging`
void read_aging(const yaml::Field& field, std::size_t slot, study::Value& value, StudyDraft& draft);

}  // namespace zerocount::keys
