#include "experiments/parameters/parameter_table.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "experiments/parameters/parameter_rows.hpp"

namespace zerocount::parameters {
namespace {

std::vector<Parameter> make_table() {
  std::vector<Parameter> table;
  const auto add = [&table](std::vector<Parameter> section, bool of_machine) {
    for (Parameter& row : section) {
      row.of_machine = of_machine;
      table.push_back(std::move(row));
    }
  };
  add(plant_rows(), true);
  add(kinematic_error_rows(), true);
  add(friction_rows(), true);
  add(encoder_rows(), true);
  add(drive_rows(), true);
  add(controller_rows(), true);
  add(filter_rows(), true);
  add(disturbance_rows(), false);
  add(command_rows(), false);
  add(initial_rows(), false);
  add(verdict_rows(), false);
  return table;
}

}  // namespace

std::span<const Parameter> parameter_table() {
  static const std::vector<Parameter> table = make_table();
  return table;
}

bool is_named(const Parameter& parameter, std::string_view path) {
  return parameter.name == path || (!parameter.short_name.empty() && parameter.short_name == path);
}

std::optional<std::size_t> find_parameter(std::string_view name) {
  const auto table = parameter_table();
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const Parameter& p) { return is_named(p, name); });
  if (found == table.end()) return std::nullopt;
  return static_cast<std::size_t>(found - table.begin());
}

Parameter value_row(const Parameter& list, std::size_t index, std::string_view name) {
  Parameter row = list;
  row.name = name;
  row.sobol_dimension += index;
  row.list.reset();
  if (const auto& set = list.list.value().set) {
    row.set = [set, index](trial::TrialParameters& parameters, double value) {
      set(parameters, index, value);
    };
  }
  return row;
}

Parameter element_row(const Parameter& key, std::size_t index, std::string_view name) {
  const ElementKey element = key.element.value();
  Parameter row = key;
  row.name = name;
  row.sobol_dimension += index * element.dimensions;
  row.element.reset();
  if (row.list) {
    row.list->set = [set = element.set, index](trial::TrialParameters& parameters, std::size_t i,
                                               double value) { set(parameters, index, i, value); };
  } else {
    row.set = [set = element.set, index](trial::TrialParameters& parameters, double value) {
      set(parameters, index, 0, value);
    };
  }
  return row;
}

Parameter plugin_row(std::string_view name, std::size_t index, const plugin::PluginParameter& parameter) {
  constexpr std::size_t first_dimension = 317;  // beyond those of the means of profiles
  Parameter row{name,
                parameter.unit,
                parameter.meaning,
                "the plugin",
                ParameterKind::real,
                {.low = parameter.lowest,
                 .high = parameter.highest,
                 .low_included = std::isfinite(parameter.lowest),
                 .high_included = std::isfinite(parameter.highest)},
                {},
                beyond_moves(first_dimension + index)};
  row.of_machine = true;
  row.get = [value = parameter.default_value](const trial::TrialParameters&) { return value; };
  row.set = [index](trial::TrialParameters& parameters, double value) {
    parameters.controller.user.parameters[index] = value;
  };
  return row;
}

std::string length_text(const ListOfValues& list) {
  if (list.min_values == list.max_values) return fmt::format("{} {}", list.max_values, list.plural);
  return fmt::format("{} to {} {}", list.min_values, list.max_values, list.plural);
}

double default_value(const Parameter& parameter) {
  return parameter.get(trial::TrialParameters{});
}

std::string unit_of(const Parameter& parameter, const StudyUnits& units) {
  const bool si = units.gains == GainUnits::si && !parameter.si_unit.empty();
  return unit_on(units.axis, si ? parameter.si_unit : parameter.unit);
}

std::string meaning_of(const Parameter& parameter, const StudyUnits& units) {
  const bool si = units.gains == GainUnits::si && !parameter.si_meaning.empty();
  return text_on(units.axis, si ? parameter.si_meaning : parameter.meaning);
}

bool default_holds(const Parameter& parameter, const StudyUnits& units) {
  if (!has_default(parameter) || has_labels(parameter)) return has_default(parameter);
  const double value = default_value(parameter);
  return value == 0.0 || value == parameter.none || unit_of(parameter, units) == parameter.unit;
}

std::string number_text(const Parameter& parameter, double number) {
  return parameter.none && number == *parameter.none ? "none" : fmt::format("{}", number);
}

std::string default_text(const Parameter& parameter, const StudyUnits& units) {
  if (!default_holds(parameter, units)) return "none";
  const double value = default_value(parameter);
  if (has_labels(parameter)) {
    return std::string(parameter.labels[static_cast<std::size_t>(value)]);
  }
  return number_text(parameter, value);
}

}  // namespace zerocount::parameters
