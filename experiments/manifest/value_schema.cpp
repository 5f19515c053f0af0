#include "experiments/manifest/value_schema.hpp"

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/distributions/distribution_forms.hpp"
#include "experiments/keys/values.hpp"
#include "experiments/study/aging.hpp"

namespace zerocount::manifest {
namespace {

Json form_schema(const distributions::DistributionForm& form) {
  const std::string name(form.name);
  return object_of({{name, shapes::schema_of(form.shape, {})}}, {name});
}

// The mean of a profile: a number, or a distribution.
Json mean_schema(const shapes::Shape&) {
  Json means = Json::array({number_in(numerics::above(0))});
  for (const distributions::DistributionForm& form : distributions::distribution_forms()) {
    if (form.name != distributions::interval_name) means.push_back(form_schema(form));
  }
  return {{"anyOf", std::move(means)}};
}

// Schema of `per`; a parameter may allow only some of the values.
Json per_schema(std::span<const std::string_view> labels) {
  return {{"enum", labels}, {"description", "how often it is drawn"}};
}

Json reference(std::string_view name) {
  return {{"$ref", "#/$defs/" + std::string(name)}};
}

// A law with its rate, and the scale of ages.
Json aging_schema() {
  Json laws = Json::array();
  for (const std::string_view law : study::aging_law_labels) {
    laws.push_back(object_of({{std::string(law), rate_schema()}, {"scale", number_in(numerics::above(0))}},
                             {law, "scale"}));
  }
  return {{"oneOf", std::move(laws)}, {"description", "how the value changes with age"}};
}

// Meaning and unit on a rotary axis, and the unit on a linear axis if it differs.
std::string description_of(const parameters::Parameter& parameter) {
  std::string description = parameters::meaning_of(parameter, {});
  if (parameter.unit == "1") return description;
  if (parameter.is_position) return description + ", count (rad with units: si; m on a linear axis)";
  description += fmt::format(", {}", parameter.unit);
  if (!parameter.si_unit.empty()) description += fmt::format(" ({} with units: si)", parameter.si_unit);
  const std::string linear = parameters::unit_on(parameters::AxisKind::linear, parameter.unit);
  if (parameter.only_on || linear == parameter.unit) return description;
  return description + fmt::format("; {} on a linear axis", linear);
}

}  // namespace

Json rate_schema() {
  Json rates = Json::array({number_in(numerics::all_numbers())});
  for (const distributions::DistributionForm& form : distributions::distribution_forms())
    rates.push_back(reference(form.name));
  return {{"anyOf", std::move(rates)}};
}

Json definitions() {
  const std::string per(keys::per_key);
  Json all = Json::object();
  for (const distributions::DistributionForm& form : distributions::distribution_forms()) {
    const std::string name(form.name);
    all[name] = form_schema(form);
    all[name]["properties"][per] = form.name == distributions::interval_name
                                       ? per_schema(std::span(&keys::draw_level_labels[1], 1))
                                       : per_schema(keys::draw_level_labels);
    all[name]["properties"][std::string(keys::aging_key)] = reference(keys::aging_key);
    all[name]["description"] = form.meaning;
  }
  all["profile"] = object_of({{"profile", shapes::schema_of(distributions::profile_shape(), mean_schema)},
                              {per, per_schema(keys::draw_level_labels_of_profiles)},
                              {std::string(keys::aging_key), reference(keys::aging_key)}},
                             {"profile"});
  all["profile"]["description"] = "friction along the rotor: a periodic random field";
  all[std::string(keys::aging_key)] = aging_schema();
  return all;
}

Json value_schema(const parameters::Parameter& parameter) {
  if (parameter.kind == parameters::ParameterKind::boolean) return {{"type", "boolean"}};
  if (parameter.kind == parameters::ParameterKind::enumeration) return {{"enum", parameter.labels}};
  const bool whole = parameter.kind == parameters::ParameterKind::whole_number;
  Json number = number_in(parameter.range, whole);
  Json forms = Json::array({number});
  if (!whole)
    forms.push_back(object_of({{std::string(keys::value_key), std::move(number)},
                               {std::string(keys::aging_key), reference(keys::aging_key)}},
                              {keys::value_key, keys::aging_key}));
  if (parameter.none) forms.push_back({{"const", "none"}});
  for (const distributions::DistributionForm& form : distributions::distribution_forms()) {
    if (!whole || form.whole_numbers || form.name == "choice") forms.push_back(reference(form.name));
  }
  if (parameter.profiled != nullptr) forms.push_back(reference("profile"));
  return {{"anyOf", std::move(forms)}};
}

parameters::Parameter in_widest_units(const parameters::Parameter& parameter) {
  return parameter.is_position ? parameters::in_si_positions(parameter) : parameter;
}

parameters::Parameter plugin_value() {
  parameters::Parameter parameter;
  parameter.range = numerics::all_numbers();
  return parameter;
}

Json key_schema(const parameters::Parameter& parameter) {
  Json schema = value_schema(in_widest_units(parameter));
  if (parameter.list) {
    schema = list_of(std::move(schema), parameter.list->min_values);
    schema["maxItems"] = parameter.list->max_values;
  }
  schema["description"] = description_of(parameter);
  if (parameter.kind == parameters::ParameterKind::boolean) {
    schema["default"] = parameters::default_value(parameter) != 0.0;
  } else if (parameter.kind == parameters::ParameterKind::enumeration) {
    schema["default"] = parameters::default_text(parameter);
  } else if (parameters::has_default(parameter)) {
    const double value = parameters::default_value(parameter);
    schema["default"] = parameter.none && value == *parameter.none ? Json("none") : Json(value);
  }
  return schema;
}

}  // namespace zerocount::manifest
