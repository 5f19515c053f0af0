#include "experiments/manifest/json_schema.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/trial/named_measures.hpp"
#include "experiments/keys/draw_level.hpp"
#include "experiments/keys/key_reading.hpp"
#include "experiments/manifest/value_schema.hpp"
#include "experiments/parameters/element_lists.hpp"
#include "experiments/parameters/measured_parameters.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/sections/observations.hpp"
#include "experiments/sections/sweep.hpp"
#include "experiments/sections/torque_record.hpp"
#include "experiments/study/sequence.hpp"

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

// Lines, and spectra from which lines are drawn.
Json vibration_schema(std::string_view path) {
  Json schema = elements_schema(*parameters::find_element_list(path));
  const Json pair = {{"type", "array"},
                     {"prefixItems", {number_in(numerics::above(0)), number_in(numerics::at_least(0))}},
                     {"minItems", 2},
                     {"maxItems", 2}};
  Json points{
      {"anyOf", {Json{{"type", "array"}, {"items", pair}, {"minItems", 2}}, Json{{"type", "string"}}}}};
  schema["items"]["oneOf"].push_back(object_of(
      {{"spectrum", std::move(points)}, {"lines", {{"type", "integer"}, {"minimum", 1}}}}, {"spectrum"}));
  return schema;
}

// The name of a table, or its pairs.
Json torque_record_schema() {
  const Json pair = {{"type", "array"},
                     {"prefixItems", {number_in(numerics::at_least(0)), Json{{"type", "number"}}}},
                     {"minItems", 2},
                     {"maxItems", 2}};
  return {
      {"anyOf",
       {Json{{"type", "array"}, {"items", pair}, {"minItems", 2}, {"maxItems", sections::max_record_rows}},
        Json{{"type", "string"}, {"minLength", 1}}}}};
}

Json spacing_schema() {
  const Json count{{"type", "integer"}, {"minimum", 2}, {"maximum", sections::max_points}};
  const auto spacing = [&](const Json& end) {
    return Json{{"type", "array"}, {"prefixItems", {end, end, count}}, {"minItems", 3}, {"maxItems", 3}};
  };
  return {{"anyOf",
           {object_of({{"linspace", spacing(number_in(numerics::all_numbers()))}}, {"linspace"}),
            object_of({{"logspace", spacing(number_in(numerics::above(0)))}}, {"logspace"})}}};
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

// A name that the user gives to a case, a condition or a goal, which stands on one line.
Json name_schema() {
  return {{"pattern", "^[^\\t\\r\\n]*$"}};
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

Json sweep_schema() {
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
  return object_of({{"grid", by_path(std::move(grid))},
                    {"cases",
                     {{"type", "object"},
                      {"propertyNames", name_schema()},
                      {"additionalProperties", assignments_schema()}}}});
}

// The ranges of tune.free.
Json free_parameters_schema() {
  const Json ends{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
  return {{"type", "object"},
          {"minProperties", 1},
          {"additionalProperties", {{"anyOf", {ends, object_of({{"log", ends}}, {"log"})}}}}};
}

// The limits of a goal, by measure.
Json limits_schema() {
  const Json largest = number_in(numerics::at_least(0));
  Json measures = Json::object();
  for (const trial::NamedMeasure& measure : trial::named_measures())
    measures[std::string(measure.name)] = largest;
  Json in_brackets{
      {fmt::format(R"(^{}\[[0-9]*\.?[0-9]+([eE][-+]?[0-9]+)?\]$)", trial::tolerance_measure), largest}};
  for (const std::string_view measure : trial::named_band_measures())
    in_brackets[fmt::format("^{}\\[[0-9]+\\]$", measure)] = largest;
  Json schema = object_of(std::move(measures));
  schema["patternProperties"] = std::move(in_brackets);
  schema["minProperties"] = 1;
  return schema;
}

// The schemas of general keys in forms of their own, by name.
Json own_schemas() {
  const Json text{{"type", "string"}};
  return {
      {"zerocount", {{"const", keys::manifest_version}}},
      {"name", {{"type", "string"}, {"pattern", "^[^\\t\\r\\n]*[^\\s][^\\t\\r\\n]*$"}}},
      {"seed", {{"type", "integer"}, {"minimum", 0}, {"maximum", std::numeric_limits<std::uint64_t>::max()}}},
      {"retain",
       object_of(
           {{"trials",
             {{"type", "array"}, {"items", {{"type", "integer"}, {"minimum", 0}}}, {"uniqueItems", true}}}})},
      {"free", free_parameters_schema()},
      {"on",
       {{"type", "array"},
        {"items", {{"type", "integer"}, {"minimum", 0}}},
        {"minItems", 1},
        {"uniqueItems", true}}},
      {"limits", limits_schema()},
      {"correlation",
       {{"type", "array"},
        {"items",
         {{"type", "array"},
          {"prefixItems", {text, text, number_in({.low = -1.0, .high = 1.0})}},
          {"minItems", 3},
          {"maxItems", 3}}}}},
      {"samples",
       {{"anyOf",
         {text,
          object_of({{"file", text},
                     {std::string(keys::per_key), {{"enum", std::span(keys::draw_level_labels).first(4)}}}},
                    {"file"})}}}},
      {"observed",
       {{"type", "object"},
        {"additionalProperties",
         {{"anyOf",
           {text,
            object_of(
                {{"successes",
                  {{"type", "integer"}, {"minimum", 0}, {"maximum", sections::max_observed_trials}}},
                 {"of", {{"type", "integer"}, {"minimum", 1}, {"maximum", sections::max_observed_trials}}},
                 {"text", text}},
                {"successes", "of"})}}}}}},
      {"conditions",
       {{"type", "object"},
        {"minProperties", 1},
        {"propertyNames", name_schema()},
        {"additionalProperties", assignments_schema()}}},
      {"ages",
       object_of({{"at", list_of(number_in(numerics::at_least(0)), 1)},
                  {"unit", {{"type", "string"}, {"pattern", "^\\S+$"}, {"default", study::Ages{}.unit}}}},
                 {"at"})},
      {"sweep", sweep_schema()},
      {"controller.plugin", {{"type", "string"}, {"minLength", 1}}},
      {"controller.parameters",
       {{"type", "object"},
        {"patternProperties", {{fmt::format("^{}$", plugin_name), value_schema(plugin_value())}}},
        {"additionalProperties", false}}},
      {"disturbance.vibration", vibration_schema("disturbance.vibration")},
      {"disturbance.load.vibration", vibration_schema("disturbance.load.vibration")},
      {"command.torque.file", torque_record_schema()},
      {"verdict.bands",
       {{"type", "array"},
        {"items", {{"type", "integer"}, {"minimum", 0}, {"maximum", keys::max_band}}},
        {"minItems", 1},
        {"maxItems", trial::max_error_bands},
        {"uniqueItems", true},
        {"default", trial::ErrorBands{}.values()}}}};
}

Json general_schema(const keys::GeneralKey& key);

Json map_schema(const std::vector<keys::GeneralKey>& keys) {
  Json properties = Json::object();
  Json required = Json::array();
  for (const keys::GeneralKey& key : keys) {
    properties[std::string(key.name)] = general_schema(key);
    if (key.required()) required.push_back(key.name);
  }
  return object_of(std::move(properties), std::move(required));
}

Json form_schema(const keys::GeneralKey& key);

Json own_schema(std::string_view name) {
  if (name == "goals") {
    return {{"type", "object"},
            {"minProperties", 1},
            {"propertyNames", name_schema()},
            {"additionalProperties", form_schema(*keys::find_general_key("goal"))}};
  }
  static const Json schemas = own_schemas();
  const std::string key(name);
  return schemas.contains(key) ? schemas[key] : elements_schema(*parameters::find_element_list(name));
}

// Schema of the value, without the word that may stand in its place.
Json form_schema(const keys::GeneralKey& key) {
  using Form = keys::GeneralKey::Form;
  const bool whole = key.form == Form::whole_number;
  Json number{{"type", whole ? "integer" : "number"}};
  switch (key.form) {
    case Form::own:
      return own_schema(key.name);
    case Form::text:
      return {{"type", "string"}};
    case Form::boolean:
      return {{"type", "boolean"}};
    case Form::label:
      return {{"enum", key.labels}};
    case Form::map:
      return map_schema(key.keys);
    case Form::whole_number:
    case Form::real:
      break;
  }
  limit(number, key.range, whole);
  return number;
}

Json default_schema(const keys::GeneralKey& key, double value) {
  if (key.form == keys::GeneralKey::Form::boolean) return value != 0.0;
  if (key.form == keys::GeneralKey::Form::label) return key.labels[static_cast<std::size_t>(value)];
  return key.form == keys::GeneralKey::Form::whole_number ? Json(static_cast<std::int64_t>(value))
                                                          : Json(value);
}

Json general_schema(const keys::GeneralKey& key) {
  Json schema = form_schema(key);
  Json forms = Json::array();
  if (!key.none.empty()) forms.push_back({{"const", key.none}});
  for (const auto& preset : key.presets) forms.push_back({{"const", preset.first}});
  if (!forms.empty()) {
    forms.push_back(std::move(schema));
    schema = {{"anyOf", std::move(forms)}};
  }
  if (const auto value = keys::default_of(key)) schema["default"] = default_schema(key, *value);
  if (!key.meaning.empty()) schema["description"] = key.meaning;
  return schema;
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
    } else if (const keys::GeneralKey* general = keys::find_general_key(name)) {
      properties[key] = general_schema(*general);
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
    const keys::GeneralKey* general = keys::find_general_key(key);
    properties[key] = general != nullptr ? general_schema(*general) : section_schema(key);
    if (general != nullptr && general->required()) required.push_back(key);
  }
  required.push_back(keys::required_section);
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "zerocount manifest"}};
  schema.update(object_of(std::move(properties), std::move(required)));
  schema["$defs"] = definitions();
  return schema;
}

}  // namespace zerocount::manifest
