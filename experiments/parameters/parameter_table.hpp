#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/numerics/interval.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::parameters {

enum class ParameterKind { real, whole_number, enumeration, boolean };

/// Description of a parameter whose value in a manifest is a list, such as the targets. Each value of the
/// list is a parameter of its own (see value_row); the row of the list itself has no value.
struct ListOfValues {
  std::size_t min_values{1};
  std::size_t max_values{0};
  std::string_view singular;  ///< noun for one value of the list, for messages: "target"
  std::string_view plural;    ///< noun for several values, for messages: "targets"
  /// Stores value `index` of the list; empty if TrialParameters has no field for it.
  std::function<void(trial::TrialParameters&, std::size_t index, double value)> set{};
};

/// Description of a row "list.#.key", which stands for one key in every element of a list
/// (element_lists.hpp). The key of each element is a parameter of its own (see element_row); the row itself
/// has no value.
struct ElementKey {
  std::size_t dimensions{0};  ///< number of dimensions of the Sobol sequence for each element
  /// Stores the value of the key in element `element`. `index` is the index in a list if the key's value is a
  /// list, otherwise 0.
  std::function<void(trial::TrialParameters&, std::size_t element, std::size_t index, double value)> set{};
};

/// The ideal of a parameter that can make moves fail: what the axis would have without this cause of
/// failures.
struct Ideal {
  std::string_view name;  ///< description of the axis without this cause of failures: "no encoder noise"
  /// The value that makes no move fail. Empty if other parameters must change as well: then idealisations.cpp
  /// in runners/tuning/effects has an effect of this name.
  std::optional<double> value{};
};

/// One row of the table of parameters: the complete description of one parameter of a trial.
struct Parameter {
  std::string_view name;  ///< dotted path in the manifest: "plant.inertia", "controller.coarse.kp"
  /// Unit on a rotary axis; "1" if dimensionless. For a gain: the unit with controller.units: count.
  std::string_view unit;
  std::string_view meaning;  ///< description, with the placeholders of text_on()
  std::string_view source;   ///< source of the default: a place in the paper, or "assumed"
  ParameterKind kind{ParameterKind::real};
  numerics::Interval range;  ///< range of the allowed values
  /// [number] label of the value, for an enumeration or boolean; otherwise empty.
  std::vector<std::string_view> labels;
  /// Dimension of the Sobol sequence that draws the parameter; for a list, the dimension of its first value.
  /// Never changed or used twice.
  std::size_t sobol_dimension{0};
  /// Field of the friction parameters that a profile along the axis replaces; null if the parameter must not
  /// vary along the axis.
  double friction::FrictionParameters::*profiled{nullptr};
  std::string_view si_unit{};     ///< unit of a gain with controller.units: si; empty for other parameters
  std::string_view si_meaning{};  ///< meaning of a gain with controller.units: si; empty for others
  std::optional<AxisKind> only_on{};  ///< the only kind of axis with this parameter; empty: both kinds
  /// Dotted path of the corresponding parameter on the other kind of axis, for messages.
  std::string_view instead{};
  /// Number that the manifest writes as "none": the limit or feature is off; empty: there is no such number.
  std::optional<double> none{};
  /// Name of a section whose key, with a number instead of a map, stands for this parameter; otherwise empty.
  std::string_view short_name{};
  /// The parameter is a target of the command, in counts or, with command.units: si, in rad (or m).
  bool is_position{false};
  bool of_machine{false};  ///< a property of the machine, not of the trial
  /// Ideal of the parameter, at which it makes no move fail; empty if it is a choice or a requirement.
  std::optional<Ideal> ideal{};
  /// Description of the list if the parameter's value is a list; otherwise empty.
  std::optional<ListOfValues> list{};
  /// Set if the row stands for one key of each element of a list of maps; otherwise empty.
  std::optional<ElementKey> element{};
  /// Reads the default from TrialParameters; empty if there is none.
  std::function<double(const trial::TrialParameters&)> get{};
  /// Stores the value in TrialParameters; empty if that has no field for it.
  std::function<void(trial::TrialParameters&, double value)> set{};
};

/// The table of parameters, in the order of columns and listings. Parsing, validation, the JSON Schema, the
/// columns of results files and `zerocount parameters` are derived from it. A study adds the rows that only
/// its manifest has (study/study_table.hpp).
std::span<const Parameter> parameter_table();

/// Maximum number of values in a list that defines the moves of a trial (targets, torque levels).
constexpr std::size_t max_moves_values = 3000;

/// Dimension of the Sobol sequence for the first value of a list that defines the moves; value i has this
/// dimension + i. Other parameters have dimensions below it, or from first_sobol_dimension_beyond_moves on.
constexpr std::size_t first_sobol_dimension_of_moves = 64;
constexpr std::size_t first_sobol_dimension_beyond_moves = first_sobol_dimension_of_moves + max_moves_values;

/// Dimension of the Sobol sequence that draws the mean of a friction parameter that varies along the axis.
/// @param of_parameter Sobol dimension of the parameter, which is not a list
constexpr std::size_t sobol_dimension_of_mean(std::size_t of_parameter) {
  return of_parameter < first_sobol_dimension_of_moves ? 3600 + of_parameter : 256 + of_parameter;
}

/// Dimension of the Sobol sequence that draws a row of the table of joint draws (`samples`).
constexpr std::size_t sobol_dimension_of_samples = 3666;

/// Index in parameter_table() of the parameter with this dotted path or short name; empty if there is none.
std::optional<std::size_t> find_parameter(std::string_view name);

/// Whether `path` is the dotted path or the short name of the parameter.
bool is_named(const Parameter& parameter, std::string_view path);

/// Whether a manifest may omit the parameter because it has a default.
inline bool has_default(const Parameter& parameter) {
  return parameter.get != nullptr;
}

/// Whether the value of the parameter is a list.
inline bool is_list(const Parameter& parameter) {
  return parameter.list.has_value();
}

/// The table row of value `index` of a list, which is a parameter of its own.
/// @param name dotted path of the value, "command.targets.0"; must outlive the row
Parameter value_row(const Parameter& list, std::size_t index, std::string_view name);

/// The table row of a key in element `index` of a list of maps, which is a parameter of its own.
/// @param name dotted path of the key, "controller.filters.0.frequency"
Parameter element_row(const Parameter& key, std::size_t index, std::string_view name);

/// The table row of parameter `index` of the user's controller (plugin).
/// @param name dotted path; must outlive the row
/// @param parameter description by the controller; must outlive the row
Parameter plugin_row(std::string_view name, std::size_t index, const plugin::PluginParameter& parameter);

/// The table row of a position of the command with command.units: si. The value is a real number in rad (or
/// m), which is converted to counts of the trial's encoder.
Parameter in_si_positions(const Parameter& position);

/// Whether the table row itself has a value. The row of a list, or of a key of all elements of a list, has
/// none.
inline bool has_value(const Parameter& parameter) {
  return !parameter.list && !parameter.element;
}

/// Whether the values of the parameter are labels (enumeration or boolean), not numbers.
inline bool has_labels(const Parameter& parameter) {
  return !parameter.labels.empty();
}

/// Whether an axis of this kind has the parameter.
inline bool exists_on(const Parameter& parameter, AxisKind axis) {
  return !parameter.only_on || *parameter.only_on == axis;
}

/// Text of the allowed length of a list: "1 to 3000 targets", "3 coefficients".
std::string length_text(const ListOfValues& list);

/// Unit of the parameter in a study; "1" if dimensionless.
std::string unit_of(const Parameter& parameter, const StudyUnits& units);

/// Meaning of the parameter, in the terms of the study's kind of axis and units.
std::string meaning_of(const Parameter& parameter, const StudyUnits& units);

/// Whether the default is valid in these units. A default of a rotary machine, such as one in N m/rad, is not
/// valid for a linear axis.
bool default_holds(const Parameter& parameter, const StudyUnits& units);

/// Default value of the parameter, from the core's structs; for labels the index of the label.
double default_value(const Parameter& parameter);

/// A number of the parameter as text for a manifest: "none" if it is Parameter::none, the number that
/// switches the limit or feature off.
std::string number_text(const Parameter& parameter, double number);

/// The default as text for a manifest; "none" also if the parameter has no default.
std::string default_text(const Parameter& parameter, const StudyUnits& units = {});

}  // namespace zerocount::parameters
