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

/// For a row whose value in a manifest is a list. Each value of the list is a parameter of its own (see
/// value_row); the row itself has no value.
struct ListOfValues {
  std::size_t min_values{1};
  std::size_t max_values{0};
  std::string_view singular;  ///< noun for a value: "target"
  std::string_view plural;
  std::function<void(trial::TrialParameters&, std::size_t index, double value)>
      set{};  ///< empty if TrialParameters has no field for it
};

/// For a row "list.#.key", which stands for a key of each element of a list (element_lists.hpp). That key is
/// a parameter of its own (see element_row); the row itself has no value.
struct ElementKey {
  std::size_t dimensions{0};  ///< Sobol dimensions of an element
  /// `index` is that of a value if the key's value is a list, otherwise 0.
  std::function<void(trial::TrialParameters&, std::size_t element, std::size_t index, double value)> set{};
};

/// How a parameter that can cost moves is idealised.
struct Ideal {
  std::string_view name;  ///< of the axis without this cause of failures: "no encoder noise"
  /// The value that costs no moves. Nothing where more changes with it: idealisations.cpp in
  /// runners/tuning/effects has an effect of this name.
  std::optional<double> value{};
};

/// One row of the table of parameters: the complete description of one parameter of a trial.
struct Parameter {
  std::string_view name;  ///< dotted path in the manifest: "plant.inertia", "controller.coarse.kp"
  std::string_view unit;  ///< on a rotary axis; of a gain with controller.units: count; "1" if dimensionless
  std::string_view meaning;  ///< with the placeholders of text_on()
  std::string_view source;   ///< of the default: a place in the paper, or "assumed"
  ParameterKind kind{ParameterKind::real};
  numerics::Interval range;              ///< of the allowed values
  std::vector<std::string_view> labels;  ///< of an enumeration or a boolean, in the order of its numbers
  std::size_t sobol_dimension{0};        ///< never changed or used twice; for a list that of its first value
  double friction::FrictionParameters::*profiled{
      nullptr};                   ///< field for a profile; null if profiles are not allowed
  std::string_view si_unit{};     ///< unit of a gain with controller.units: si; empty for other parameters
  std::string_view si_meaning{};  ///< meaning of such a gain
  std::optional<AxisKind> only_on{};  ///< the only kind of axis with this parameter; empty: both kinds
  std::string_view instead{};         ///< the corresponding key on the other kind of axis, for messages
  std::optional<double> none{};   ///< the value written as the word "none": what the parameter limits is off
  std::string_view short_name{};  ///< of the section, where its key alone stands for this parameter
  bool is_position{false};        ///< a target of the command, in counts or, with command.units: si, in rad
  bool of_machine{false};         ///< a property of the machine, not of the trial
  std::optional<Ideal> ideal{};   ///< empty for what is chosen or asked for, and has no ideal value
  std::optional<ListOfValues> list{};   ///< set if its value is a list
  std::optional<ElementKey> element{};  ///< set if it stands for a key of each element of a list
  std::function<double(const trial::TrialParameters&)> get{};  ///< empty without a default
  std::function<void(trial::TrialParameters&, double value)>
      set{};  ///< empty if TrialParameters has no field
};

/// The table of parameters, in the order of columns and listings. Parsing, validation, the JSON Schema, the
/// columns of results files and `zerocount parameters` are derived from it. A study adds the rows that only
/// its manifest has (study/study_table.hpp).
std::span<const Parameter> parameter_table();

/// Maximum number of values of a list that defines the moves.
constexpr std::size_t max_moves_values = 3000;

/// Sobol dimension of value i of a list that defines the moves: this number + i. Other parameters have
/// dimensions below it, or from first_sobol_dimension_beyond_moves on.
constexpr std::size_t first_sobol_dimension_of_moves = 64;
constexpr std::size_t first_sobol_dimension_beyond_moves = first_sobol_dimension_of_moves + max_moves_values;

/// Sobol dimension of the drawn mean of a profile, by the dimension of its parameter, which is not a list.
constexpr std::size_t sobol_dimension_of_mean(std::size_t of_parameter) {
  return of_parameter < first_sobol_dimension_of_moves ? 3600 + of_parameter : 256 + of_parameter;
}

/// Sobol dimension of the row of joint draws (`samples`).
constexpr std::size_t sobol_dimension_of_samples = 3666;

/// Row of the parameter with this dotted path, or of which it is the short name.
std::optional<std::size_t> find_parameter(std::string_view name);

/// Whether this dotted path, or the short name, is the parameter's.
bool is_named(const Parameter& parameter, std::string_view path);

/// Whether the parameter may be omitted.
inline bool has_default(const Parameter& parameter) {
  return parameter.get != nullptr;
}

/// Whether its value is a list.
inline bool is_list(const Parameter& parameter) {
  return parameter.list.has_value();
}

/// The row of value `index` of a list. @param name its dotted path, "command.targets.0"; must outlive the row
Parameter value_row(const Parameter& list, std::size_t index, std::string_view name);

/// The row of a key of element `index`. @param name its dotted path, "controller.filters.0.frequency"
Parameter element_row(const Parameter& key, std::size_t index, std::string_view name);

/// The row of parameter `index` of the user's controller, which must outlive the row, like `name`.
Parameter plugin_row(std::string_view name, std::size_t index, const plugin::PluginParameter& parameter);

/// The row of a position of the command with command.units: si: real numbers in rad, which the trial's
/// encoder turns into counts.
Parameter in_si_positions(const Parameter& position);

/// Whether the row itself has a value: it stands for no others.
inline bool has_value(const Parameter& parameter) {
  return !parameter.list && !parameter.element;
}

/// Whether its values are labels (of an enumeration or a boolean), not numbers.
inline bool has_labels(const Parameter& parameter) {
  return !parameter.labels.empty();
}

/// Whether an axis of this kind has the parameter.
inline bool exists_on(const Parameter& parameter, AxisKind axis) {
  return !parameter.only_on || *parameter.only_on == axis;
}

/// Noun for the length of a list: "1 to 3000 targets", "3 coefficients".
std::string length_text(const ListOfValues& list);

/// Its unit in a study; "1" if dimensionless.
std::string unit_of(const Parameter& parameter, const StudyUnits& units);

/// Its meaning, in the terms of the study's kind of axis and units.
std::string meaning_of(const Parameter& parameter, const StudyUnits& units);

/// Whether the default is valid in these units. A default of a rotary machine, such as one in N m/rad, is not
/// valid for a linear axis.
bool default_holds(const Parameter& parameter, const StudyUnits& units);

/// Default value, from the core's structs; for labels the index of the label.
double default_value(const Parameter& parameter);

/// A number of the parameter as text for a manifest: the word "none" for the value that it stands for.
std::string number_text(const Parameter& parameter, double number);

/// The default as text for a manifest; "none" without a default too.
std::string default_text(const Parameter& parameter, const StudyUnits& units = {});

}  // namespace zerocount::parameters
