#pragma once

#include <algorithm>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "experiments/parameters/parameter_table.hpp"

namespace zerocount {

// The rows of the table of parameters, section by section. A new row also goes to the end of the
// order in which parameters have Sobol dimensions (sobol_order.cpp).

std::vector<Parameter> plant_rows();
std::vector<Parameter> friction_rows();
std::vector<Parameter> encoder_rows();
std::vector<Parameter> drive_rows();  ///< of the converter and the amplifier
std::vector<Parameter> controller_rows();
std::vector<Parameter> command_rows();
std::vector<Parameter> initial_rows();
std::vector<Parameter> verdict_rows();

constexpr std::string_view assumed = "assumed";

/// Largest magnitude of a target and of a counts-per-revolution: far above any machine's, and exact as a
/// double with the whole arithmetic of counts around it.
constexpr double max_count = 1e12;

/// A row of real numbers.
inline Parameter real_row(std::string_view name, std::string_view unit, std::string_view meaning,
                          std::string_view source, const Interval& range) {
  return {name, unit, meaning, source, ParameterKind::real, range, {}};
}

/// A row of whole numbers.
inline Parameter whole_row(std::string_view name, std::string_view unit, std::string_view meaning,
                           std::string_view source, const Interval& range) {
  return {name, unit, meaning, source, ParameterKind::whole_number, range, {}};
}

/// A row of words, in the order of the enumeration's values.
inline Parameter word_row(std::string_view name, std::string_view meaning, std::string_view source,
                          std::vector<std::string_view> words) {
  const Interval range = closed(0, static_cast<double>(words.size() - 1));
  return {name, "1", meaning, source, ParameterKind::enumeration, range, std::move(words)};
}

/// A row of `true` or `false`.
inline Parameter truth_row(std::string_view name, std::string_view meaning, std::string_view source) {
  return {name, "1", meaning, source, ParameterKind::truth, closed(0, 1), {"false", "true"}};
}

/// Completes a row with the way to and from the trial's parameters: `At` returns a reference to the field.
template <class At>
Parameter stored_at(Parameter row, At) {
  row.get = [](const TrialParameters& parameters) { return static_cast<double>(At{}(parameters)); };
  row.set = [](TrialParameters& parameters, double value) {
    auto& field = At{}(parameters);
    field = static_cast<std::remove_reference_t<decltype(field)>>(value);
  };
  return row;
}

/// The same of a limit in counts, which no count exceeds where it is max_count: in the trial's parameters
/// that limit is infinite.
template <class At>
Parameter or_never(Parameter row, At) {
  row.get = [](const TrialParameters& parameters) { return std::min(At{}(parameters), max_count); };
  row.set = [](TrialParameters& parameters, double value) {
    At{}(parameters) = value < max_count ? value : std::numeric_limits<double>::infinity();
  };
  return row;
}

/// A row that has a place in the trial's parameters, and must be given where it has a meaning.
inline Parameter without_default(Parameter row) {
  row.get = nullptr;
  return row;
}

/// A gain: with controller.units: si it has this unit and meaning.
inline Parameter in_si(Parameter row, std::string_view unit, std::string_view meaning) {
  row.si_unit = unit;
  row.si_meaning = meaning;
  return row;
}

/// A row that only one kind of axis has. @param instead what to give on the other.
inline Parameter only_on(AxisKind axis, std::string_view instead, Parameter row) {
  row.only_on = axis;
  row.instead = instead;
  return row;
}

/// A row whose value is a list.
inline Parameter list_of(Parameter row) {
  row.listed = true;
  return row;
}

}  // namespace zerocount
