#pragma once

#include <algorithm>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::parameters {

// The rows of the table of parameters, by section. Each has a Sobol dimension of its own, so that a new row
// does not change the draws of the others. The next free ones are beyond_moves(307)
// to (316); beyond_moves(17) to (26) and (32) to (57) are those of the blocks of the controller. Lists have
// dimensions from beyond_moves(80) on, as many as they may have values; the last is beyond_moves(263). A
// plugin has the dimensions from beyond_moves(317) to beyond_moves(444), lists of the second mass those up to
// beyond_moves(516).

std::vector<Parameter> plant_rows();
/// Rows of the table of parameters for the kinematic error of the coupling to a second mass.
std::vector<Parameter> kinematic_error_rows();
std::vector<Parameter> friction_rows();
std::vector<Parameter> encoder_rows();
/// Rows of the table of parameters for the converter (DAC) and the amplifier.
std::vector<Parameter> drive_rows();
std::vector<Parameter> controller_rows();
std::vector<Parameter> filter_rows();
std::vector<Parameter> disturbance_rows();
std::vector<Parameter> command_rows();
std::vector<Parameter> initial_rows();
std::vector<Parameter> verdict_rows();

/// Number `i` of the Sobol dimensions that follow those of the moves' values.
constexpr std::size_t beyond_moves(std::size_t i) {
  return first_sobol_dimension_beyond_moves + i;
}

constexpr std::string_view assumed = "assumed";

// Names of effects that idealise several parameters, or how they begin.
constexpr std::string_view finer_converter = "a converter 16 times finer";
constexpr std::string_view wider_torque_range = "a torque range";
constexpr std::string_view finer_encoder = "an encoder 4 times finer";
constexpr std::string_view faster_sampling = "twice the sample rate";
constexpr std::string_view rigid_axis = "a rigid axis";
constexpr std::string_view stiffer_coupling = "a coupling 100 times stiffer";
constexpr std::string_view no_load_friction = "no friction of the load";
constexpr std::string_view no_constant_disturbance = "no constant disturbance";
constexpr std::string_view no_constant_load_disturbance = "no constant disturbance of the load";
constexpr std::string_view no_ripple = "no ripple";
constexpr std::string_view no_integral = "no integral of the control";
constexpr std::string_view no_filter = "no filter";
constexpr std::string_view damping_feedforward = "a feed-forward of the damping";
constexpr std::string_view inertia_feedforward = "a feed-forward of the inertia";
constexpr std::string_view friction_feedforward = "a feed-forward of the sliding friction";
constexpr std::string_view faster_profile = "a profile";

/// Maximum |target| and maximum counts per revolution: far above those of real machines, and small enough for
/// exact arithmetic of counts in double.
constexpr double max_count = 1e12;

/// Range of all control gains, whatever the axis (from a galvanometer to a telescope) and the unit. The
/// maximum is far above the gains of real machines, and far below the maximum of a double. Whether a gain is
/// plausible for the axis at hand is checked by rules::plausible_gains().
constexpr numerics::Interval gain_range{.low = 0, .high = 1e15, .low_included = true, .high_included = true};

/// Stands for the access to TrialParameters in table rows whose value has no field there.
struct NoField {};

inline Parameter stored_at(Parameter row, NoField) {
  return row;
}

// The accesses of all rows have one type, pointer to function: the + converts the lambda. With a type for
// each row, the compiler would instantiate std::function hundreds of times.

/// Adds the access to the field of TrialParameters: `Field` returns a pointer to it.
template <class Field>
Parameter stored_at(Parameter row, Field) {
  row.get =
      +[](const trial::TrialParameters& parameters) { return static_cast<double>(*Field{}(parameters)); };
  row.set = +[](trial::TrialParameters& parameters, double value) {
    auto& field = *Field{}(parameters);
    field = static_cast<std::remove_reference_t<decltype(field)>>(value);
  };
  return row;
}

/// Adds to a table row the access to a field of TrialParameters that is a limit. A manifest writes "none" if
/// the limit is off. The number that stands for "none" is max_count; the field is then infinity.
template <class Field>
Parameter or_none(Parameter row, Field) {
  row.none = max_count;
  row.get =
      +[](const trial::TrialParameters& parameters) { return std::min(*Field{}(parameters), max_count); };
  row.set = +[](trial::TrialParameters& parameters, double value) {
    *Field{}(parameters) = value < max_count ? value : std::numeric_limits<double>::infinity();
  };
  return row;
}

/// A row of the table of parameters whose values are real numbers.
template <class Field = NoField>
Parameter real_row(parameter::Handle name, std::size_t sobol_dimension, std::string_view unit,
                   std::string_view meaning, std::string_view source, const numerics::Interval& range,
                   Field field = {}) {
  return stored_at({name, unit, meaning, source, ParameterKind::real, range, {}, sobol_dimension}, field);
}

/// A row of the table of parameters whose values are whole numbers.
template <class Field = NoField>
Parameter whole_row(parameter::Handle name, std::size_t sobol_dimension, std::string_view unit,
                    std::string_view meaning, std::string_view source, const numerics::Interval& range,
                    Field field = {}) {
  return stored_at({name, unit, meaning, source, ParameterKind::whole_number, range, {}, sobol_dimension},
                   field);
}

/// A row of the table of parameters whose values are labels, in the order of the enumeration's values.
template <class Field>
Parameter word_row(parameter::Handle name, std::size_t sobol_dimension, std::string_view meaning,
                   std::string_view source, std::vector<std::string_view> labels, Field field) {
  const numerics::Interval range = numerics::closed(0, static_cast<double>(labels.size() - 1));
  return stored_at(
      {name, "1", meaning, source, ParameterKind::enumeration, range, std::move(labels), sobol_dimension},
      field);
}

/// A row of the table of parameters with the values `true` or `false`.
template <class Field>
Parameter bool_row(parameter::Handle name, std::size_t sobol_dimension, std::string_view meaning,
                   std::string_view source, Field field) {
  return stored_at({name,
                    "1",
                    meaning,
                    source,
                    ParameterKind::boolean,
                    numerics::closed(0, 1),
                    {"false", "true"},
                    sobol_dimension},
                   field);
}

/// Marks the row of a parameter that is a position in counts. With command.units: si the manifest gives it in
/// rad, or m (see in_si_positions).
inline Parameter position(Parameter row) {
  row.is_position = true;
  return row;
}

/// Adds to a row the number that a manifest writes as "none" (the limit or feature is off). It lies outside
/// the range of the other values.
inline Parameter none_is(double none, Parameter row) {
  row.none = none;
  return row;
}

/// Makes the number that a manifest writes as "none" the default of a row without a field.
inline Parameter none_by_default(double none, Parameter row) {
  row.get = [none](const trial::TrialParameters&) { return none; };
  return none_is(none, std::move(row));
}

/// Adds to a row the ideal value of the parameter, at which it makes no move fail.
/// @param name Ideal::name
inline Parameter ideal_at(double value, std::string_view name, Parameter row) {
  row.ideal = Ideal{name, value};
  return row;
}

/// Marks a parameter whose ideal changes several parameters at once (Ideal::value is empty).
/// @param name Ideal::name
inline Parameter idealised_by(std::string_view name, Parameter row) {
  row.ideal = Ideal{name, std::nullopt};
  return row;
}

/// Lets the key of the section, with a number instead of a map, stand for this parameter.
inline Parameter short_for(std::string_view section, Parameter row) {
  row.short_name = section;
  return row;
}

/// Marks a parameter as required wherever it has an effect: the row gets no default.
inline Parameter without_default(Parameter row) {
  row.get = nullptr;
  return row;
}

/// Adds to the row of a gain its unit and meaning with controller.units: si.
inline Parameter in_si(Parameter row, std::string_view unit, std::string_view meaning) {
  row.si_unit = unit;
  row.si_meaning = meaning;
  return row;
}

/// Restricts the parameter of a row to one kind of axis.
/// @param instead the corresponding key on the other kind of axis
inline Parameter only_on(AxisKind axis, std::string_view instead, Parameter row) {
  row.only_on = axis;
  row.instead = instead;
  return row;
}

/// Makes a row the row of a parameter whose value is a list. `Field` returns a pointer to the field of value
/// `index` in TrialParameters.
/// @param singular noun for one value
/// @param plural noun for several values
template <class Field>
Parameter list_of(std::size_t max_values, std::string_view singular, std::string_view plural, Parameter row,
                  Field) {
  row.list = {1, max_values, singular, plural,
              +[](trial::TrialParameters& parameters, std::size_t index, double value) {
                auto& field = *Field{}(parameters, index);
                field = static_cast<std::remove_reference_t<decltype(field)>>(value);
              }};
  return row;
}
inline Parameter list_of(std::size_t max_values, std::string_view singular, std::string_view plural,
                         Parameter row, NoField) {
  row.list = {1, max_values, singular, plural, {}};
  return row;
}

}  // namespace zerocount::parameters
