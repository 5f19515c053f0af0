#include "experiments/manifest/json_schema.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/manifest/value_schema.hpp"
#include "experiments/parameters/element_lists.hpp"
#include "experiments/parameters/measured_parameters.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/sections/sections.hpp"
#include "experiments/shapes/shape_schema.hpp"

namespace zerocount::manifest {
namespace {

// The name of a plugin's parameter.
constexpr std::string_view plugin_name = "[a-z][a-z0-9_]*";

// A list of maps, each of one form.
Json elements_schema(const parameters::ElementList& list) {
  Json forms = Json::array();
  for (const parameters::ElementForm& form : list.forms) {
    Json properties = Json::object();
    Json required = Json::array();
    for (const std::string_view key : form.keys) {
      const auto found = parameters::find_parameter(fmt::format("{}.#.{}", list.path, key));
      const parameters::Parameter& row = parameters::parameter_table()[found.value()];
      properties[std::string(key)] = key_schema(row);
      if (!parameters::has_default(row)) required.push_back(key);
    }
    const std::string name(form.name);
    Json keys = object_of(std::move(properties), std::move(required));
    forms.push_back(name.empty() ? std::move(keys) : object_of({{name, std::move(keys)}}, {name}));
    forms.back()["description"] = form.meaning;
  }
  return {{"type", "array"}, {"items", {{"oneOf", std::move(forms)}}}, {"maxItems", list.max_elements}};
}

Json schema_of(const shapes::Shape& shape);

Json spacing_schema() {
  Json forms = Json::array();
  for (const bool logarithmic : {false, true})
    forms.push_back(
        schema_of(shapes::of(shapes::Shape::Form::map, {}, "", {sections::spacing_shape(logarithmic)})));
  return {{"anyOf", std::move(forms)}};
}

// A dotted path as a regular expression, with indices for #; that of a list's value ends in an index.
std::string pattern_of(std::string_view name, bool value) {
  constexpr std::string_view index = "(0|[1-9][0-9]*)";
  std::string pattern = "^";
  for (const char c : name)
    pattern += c == '.' ? std::string("\\.") : c == '#' ? std::string(index) : std::string(1, c);
  return pattern + (value ? fmt::format("\\.{}$", index) : "$");
}

// A map from dotted paths to what is allowed there.
Json by_path(Json patterns) {
  return {{"type", "object"}, {"patternProperties", std::move(patterns)}, {"additionalProperties", false}};
}

// The values that a case or a condition gives to parameters, by pattern.
Json assignments_schema() {
  Json assignments = Json::object();
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    const Json value = value_schema(in_widest_units(parameter));
    for (const std::string_view name : {parameter.name, parameter.short_name}) {
      if (!name.empty())
        assignments[pattern_of(name, false)] = parameters::is_list(parameter) ? list_of(value, 1) : value;
    }
    if (parameters::is_list(parameter)) assignments[pattern_of(parameter.name, true)] = value;
  }
  assignments[std::string(rate_pattern)] = rate_schema();
  assignments[fmt::format("^controller\\.parameters\\.{}$", plugin_name)] = value_schema(plugin_value());
  return by_path(std::move(assignments));
}

Json grid_schema() {
  Json grid = Json::object();
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    const Json value = value_schema(in_widest_units(parameter));
    const Json spaced = {{"anyOf", {list_of(value, 1), spacing_schema()}}};
    const bool numeric = !parameters::has_labels(parameter);
    const Json whole_value = parameters::is_list(parameter) ? list_of(value, 1) : value;
    for (const std::string_view name : {parameter.name, parameter.short_name}) {
      if (name.empty()) continue;
      grid[pattern_of(name, false)] =
          numeric && !parameters::is_list(parameter) ? spaced : list_of(whole_value, 1);
    }
    if (parameters::is_list(parameter)) {
      grid[pattern_of(parameter.name, true)] = spaced;
    }
  }
  grid[std::string(rate_pattern)] = {{"anyOf", {list_of(rate_schema(), 1), spacing_schema()}}};
  const std::string of_plugin = fmt::format("^controller\\.parameters\\.{}$", plugin_name);
  grid[of_plugin] = {{"anyOf", {list_of(value_schema(plugin_value()), 1), spacing_schema()}}};
  return by_path(std::move(grid));
}

// Lists of elements, and what only their section reads.
Json own_schema(const shapes::Shape& shape) {
  if (shape.name == "grid") return grid_schema();
  if (shape.name == "assignments") return assignments_schema();
  if (shape.name == "controller.parameters")
    return by_path({{fmt::format("^{}$", plugin_name), value_schema(plugin_value())}});
  const parameters::ElementList& list = *parameters::find_element_list(shape.name);
  Json schema = elements_schema(list);
  if (parameters::has_spectra(list)) schema["items"]["oneOf"].push_back(schema_of(keys::spectrum_shape()));
  return schema;
}

Json schema_of(const shapes::Shape& shape) {
  return shapes::schema_of(shape, own_schema);
}

// Exactly one of these keys.
Json one_of_keys(std::span<const std::string_view> keys) {
  Json forms = Json::array();
  for (const std::string_view key : keys) forms.push_back({{"required", {key}}});
  return forms;
}

// Requires counts of the command unless its units are SI.
void require_counts(Json& command) {
  Json counts = Json::object();
  for (const parameters::Parameter& row : parameters::parameter_table()) {
    if (!row.is_position) continue;
    const Json value = value_schema(row);
    const std::string pointer = boost::algorithm::replace_all_copy(
        std::string(row.name).substr(keys::required_section.size()), ".", "/properties/");
    counts[Json::json_pointer(pointer)] = row.list ? Json{{"items", value}} : value;
  }
  command["if"] = {{"properties", {{"units", {{"const", "si"}}}}}, {"required", {"units"}}};
  command["else"] = std::move(counts);
}

Json section_schema(const std::string& path);

// A section that may be written in short as the value of one of its parameters.
Json section_or_value_schema(const std::string& path) {
  Json section = section_schema(path);
  const auto row = parameters::find_parameter(path);
  if (!row) return section;
  return {{"anyOf", {key_schema(parameters::parameter_table()[*row]), std::move(section)}}};
}

// Whether the parameter is of a group of measured values: one may stand for others.
bool is_measured(std::string_view name) {
  return std::ranges::any_of(parameters::measured_parameters(), [name](const auto& group) {
    return std::ranges::find(group.names, name) != group.names.end();
  });
}

// The map of the keys below this dotted path.
Json section_schema(const std::string& path) {
  Json properties = Json::object();
  Json required = Json::array();
  for (const std::string& key : keys::keys_below(path)) {
    const std::string name = fmt::format("{}.{}", path, key);
    if (const auto row = parameters::find_parameter(name); row && !keys::is_section(name)) {
      const parameters::Parameter& parameter = parameters::parameter_table()[*row];
      properties[key] = key_schema(parameter);
      const bool always = !parameters::has_default(parameter) && !parameter.only_on && !is_measured(name);
      if (always && path != keys::required_section) required.push_back(key);
    } else if (const shapes::Shape* general = keys::find_general_key(name)) {
      properties[key] = schema_of(*general);
      if (general->required()) required.push_back(key);
    } else {
      properties[key] = section_or_value_schema(name);
    }
  }
  const bool torque = path == "command.torque";
  if (torque) required.clear();
  Json schema = object_of(std::move(properties), std::move(required));
  if (torque) {
    constexpr std::array<std::string_view, 2> forms{"levels", "file"};
    schema["oneOf"] = one_of_keys(forms);
  }
  if (path == keys::required_section) {
    schema["oneOf"] = one_of_keys(keys::command_forms);
    require_counts(schema);
  }
  return schema;
}

}  // namespace

nlohmann::ordered_json json_schema() {
  Json properties = Json::object();
  Json required = Json::array();
  for (const std::string& key : keys::keys_below("")) {
    const shapes::Shape* general = keys::find_general_key(key);
    properties[key] = general != nullptr ? schema_of(*general) : section_schema(key);
    if (general != nullptr && general->required()) required.push_back(key);
  }
  required.push_back(keys::required_section);
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "zerocount manifest"}};
  schema.update(object_of(std::move(properties), std::move(required)));
  schema["$defs"] = definitions();
  return schema;
}

}  // namespace zerocount::manifest
