#include "experiments/language/json_schema.hpp"

#include <cmath>
#include <cstdint>
#include <string>

#include "experiments/distributions/distribution_forms.hpp"
#include "experiments/language/manifest.hpp"
#include "experiments/language/manifest_keys.hpp"
#include "experiments/language/sweep.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount {
namespace {

using Json = nlohmann::ordered_json;

Json object_of(Json properties, Json required = Json::array()) {
  Json schema{{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

Json list_of(Json item, std::size_t fewest) {
  return {{"type", "array"}, {"items", std::move(item)}, {"minItems", fewest}};
}

Json list_of_exactly(Json item, std::size_t count) {
  Json schema = list_of(std::move(item), count);
  schema["maxItems"] = count;
  return schema;
}

void limit(Json& schema, const Interval& range, bool whole) {
  const auto number = [&](double value) -> Json {
    return whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
  };
  if (std::isfinite(range.low))
    schema[range.low_included ? "minimum" : "exclusiveMinimum"] = number(range.low);
  if (std::isfinite(range.high))
    schema[range.high_included ? "maximum" : "exclusiveMaximum"] = number(range.high);
}

Json number_in(const Interval& range) {
  Json schema{{"type", "number"}};
  limit(schema, range, false);
  return schema;
}

Json distribution_schema(const DistributionForm& form) {
  const Json number{{"type", form.whole_numbers ? "integer" : "number"}};
  if (!form.by_key) {
    return form.keys.empty() ? list_of(number, 1) : list_of_exactly(number, form.keys.size());
  }
  Json properties = Json::object();
  for (const std::string_view key : form.keys) properties[std::string(key)] = number;
  return object_of(std::move(properties), Json(form.keys));
}

Json profile_schema() {
  return object_of(
      {{"mean", number_in(above(0))},
       {"cv", number_in({.low = 0, .high = 10, .high_included = true})},
       {"correlation_length", number_in(closed(shortest_correlation_length, longest_correlation_length))},
       {"marginal", {{"enum", {"normal", "lognormal"}}}}},
      {"mean", "cv", "correlation_length"});
}

// One definition for each distribution: {"uniform": [low, high]}.
Json definitions() {
  Json all = Json::object();
  for (const DistributionForm& form : distribution_forms()) {
    const std::string name(form.name);
    all[name] = object_of({{name, distribution_schema(form)}}, {name});
    all[name]["description"] = form.meaning;
  }
  all["profile"] = object_of({{"profile", profile_schema()}}, {"profile"});
  all["profile"]["description"] = "friction along the rotor: a periodic random field";
  return all;
}

Json reference(std::string_view name) {
  return {{"$ref", "#/$defs/" + std::string(name)}};
}

// What may stand for one value of the parameter.
Json value_schema(const Parameter& parameter) {
  if (parameter.kind == ParameterKind::enumeration) return {{"enum", parameter.words}};
  const bool whole = parameter.kind == ParameterKind::whole_number;
  Json number{{"type", whole ? "integer" : "number"}};
  limit(number, parameter.range, whole);
  Json forms = Json::array({std::move(number)});
  for (const DistributionForm& form : distribution_forms()) {
    if (!whole || form.whole_numbers || form.keys.empty()) forms.push_back(reference(form.name));
  }
  if (parameter.profiled != nullptr) forms.push_back(reference("profile"));
  return {{"anyOf", std::move(forms)}};
}

Json key_schema(const Parameter& parameter) {
  Json schema = parameter.per_move ? list_of(value_schema(parameter), 1) : value_schema(parameter);
  schema["description"] = parameter.unit == "1"
                              ? std::string(parameter.meaning)
                              : std::string(parameter.meaning) + ", " + std::string(parameter.unit);
  if (parameter.kind == ParameterKind::enumeration) {
    schema["default"] = default_text(parameter);
  } else if (!parameter.per_move) {
    schema["default"] = default_value(parameter);
  }
  return schema;
}

Json section_schema(const std::string& section) {
  Json properties = Json::object();
  Json required = Json::array();
  for (const Parameter& parameter : parameter_table()) {
    const std::size_t dot = parameter.name.find('.');
    if (parameter.name.substr(0, dot) != section) continue;
    const std::string key(parameter.name.substr(dot + 1));
    properties[key] = key_schema(parameter);
    if (parameter.per_move) required.push_back(key);
  }
  return object_of(std::move(properties), std::move(required));
}

Json spacing_schema() {
  const Json count{{"type", "integer"}, {"minimum", 2}, {"maximum", most_points}};
  const auto spacing = [&](const Json& end) {
    return Json{{"type", "array"}, {"prefixItems", {end, end, count}}, {"minItems", 3}, {"maxItems", 3}};
  };
  return {{"anyOf",
           {object_of({{"linspace", spacing(number_in(all_numbers()))}}, {"linspace"}),
            object_of({{"logspace", spacing(number_in(above(0)))}}, {"logspace"})}}};
}

// A dotted path as a regular expression; that of a list's element ends in an index.
std::string pattern_of(const Parameter& parameter, bool element) {
  std::string pattern = "^";
  for (const char c : parameter.name) pattern += c == '.' ? std::string("\\.") : std::string(1, c);
  return pattern + (element ? "\\.(0|[1-9][0-9]*)$" : "$");
}

Json sweep_schema() {
  Json grid = Json::object();
  Json assignments = Json::object();
  for (const Parameter& parameter : parameter_table()) {
    const Json value = value_schema(parameter);
    const Json spaced = {{"anyOf", {list_of(value, 1), spacing_schema()}}};
    const bool numeric = parameter.kind != ParameterKind::enumeration;
    const Json whole_value = parameter.per_move ? list_of(value, 1) : value;
    assignments[pattern_of(parameter, false)] = whole_value;
    grid[pattern_of(parameter, false)] = numeric && !parameter.per_move ? spaced : list_of(whole_value, 1);
    if (parameter.per_move) {
      assignments[pattern_of(parameter, true)] = value;
      grid[pattern_of(parameter, true)] = spaced;
    }
  }
  const auto by_pattern = [](Json patterns) {
    return Json{
        {"type", "object"}, {"patternProperties", std::move(patterns)}, {"additionalProperties", false}};
  };
  return object_of(
      {{"grid", by_pattern(std::move(grid))},
       {"cases", {{"type", "object"}, {"additionalProperties", by_pattern(std::move(assignments))}}}});
}

// The schema of each key that is no section, without its description.
Json general_schemas() {
  const Json text{{"type", "string"}};
  return {
      {"zerocount", {{"const", manifest_version}}},
      {"name", {{"type", "string"}, {"pattern", "\\S"}}},
      {"description", text},
      {"seed", {{"type", "integer"}, {"minimum", 0}, {"maximum", std::numeric_limits<std::uint64_t>::max()}}},
      {"trials", {{"type", "integer"}, {"minimum", 1}, {"maximum", std::int64_t{1} << 53}}},
      {"design", {{"enum", std::vector<std::string_view>(design_words().begin(), design_words().end())}}},
      {"independent_points", {{"type", "boolean"}}},
      {"retain",
       object_of(
           {{"trials",
             {{"type", "array"}, {"items", {{"type", "integer"}, {"minimum", 0}}}, {"uniqueItems", true}}}})},
      {"observed", {{"type", "object"}, {"additionalProperties", text}}},
      {"sweep", sweep_schema()}};
}

}  // namespace

nlohmann::ordered_json json_schema() {
  const Json general = general_schemas();
  Json properties = Json::object();
  Json required = Json::array();
  for (const GeneralKey& key : general_keys()) {
    properties[std::string(key.name)] = general.at(std::string(key.name));
    properties[std::string(key.name)]["description"] = key.meaning;
    if (key.required) required.push_back(key.name);
  }
  for (const std::string& section : section_names()) properties[section] = section_schema(section);
  required.push_back(required_section);
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "zerocount manifest"}};
  schema.update(object_of(std::move(properties), std::move(required)));
  schema["$defs"] = definitions();
  return schema;
}

}  // namespace zerocount
