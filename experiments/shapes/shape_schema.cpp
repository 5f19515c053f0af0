#include "experiments/shapes/shape_schema.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

namespace zerocount::shapes {
namespace {

using Form = Shape::Form;
using OwnSchema = std::function<Json(const Shape&)>;

Json pattern(const char* expression) {
  return {{"type", "string"}, {"pattern", expression}};
}

Json all_of_parts(const Shape& shape, const OwnSchema& own) {
  Json all = Json::array();
  for (const Shape& part : shape.parts) all.push_back(schema_of(part, own));
  return all;
}

void limit_count(Json& schema, const Shape& shape, const std::string& noun) {
  if (shape.min_count > 0) schema["min" + noun] = shape.min_count;
  if (shape.max_count < std::numeric_limits<std::size_t>::max()) schema["max" + noun] = shape.max_count;
}

Json list_schema(const Shape& shape, const OwnSchema& own) {
  Json schema{{"type", "array"}};
  if (shape.form == Form::tuple) {
    const std::size_t count = shape.parts.size();
    schema["prefixItems"] = all_of_parts(shape, own);
    schema.update({{"minItems", count}, {"maxItems", count}});
    return schema;
  }
  schema["items"] = schema_of(shape.parts.front(), own);
  limit_count(schema, shape, "Items");
  if (shape.order != Shape::Order::any) schema["uniqueItems"] = true;
  return schema;
}

Json map_schema(const Shape& shape, const OwnSchema& own) {
  Json properties = Json::object();
  Json required = Json::array();
  Json one_of_two;
  for (const Shape& key : shape.parts) {
    properties[std::string(key.name)] = schema_of(key, own);
    if (!key.in_its_place.empty()) {
      one_of_two = {{{"required", {key.name}}}, {{"required", {key.in_its_place}}}};
    } else if (key.required()) {
      required.push_back(key.name);
    }
  }
  Json schema = object_of(std::move(properties), std::move(required));
  if (!one_of_two.is_null()) schema["oneOf"] = std::move(one_of_two);
  return schema;
}

Json entries_schema(const Shape& shape, const OwnSchema& own) {
  const Json value = schema_of(shape.parts.front(), own);
  Json schema{{"type", "object"}};
  if (shape.named) schema["propertyNames"] = {{"pattern", "^[^\\t\\r\\n]*$"}};
  for (const std::string& one : shape.patterns) schema["patternProperties"][one] = value;
  schema["additionalProperties"] = shape.patterns.empty() ? value : Json(false);
  limit_count(schema, shape, "Properties");
  return schema;
}

/// JSON Schema of the value of the shape, without the words (such as "none") that may replace it.
Json form_schema(const Shape& shape, const OwnSchema& own) {
  switch (shape.form) {
    case Form::own:
      return own(shape);
    case Form::text:
      return {{"type", "string"}};
    case Form::line:
      return pattern("^[^\\t\\r\\n]*[^\\s][^\\t\\r\\n]*$");
    case Form::word:
      return pattern("^\\S+$");
    case Form::seed:
      return {{"type", "integer"}, {"minimum", 0}, {"maximum", std::numeric_limits<std::uint64_t>::max()}};
    case Form::boolean:
      return {{"type", "boolean"}};
    case Form::label:
      return {{"enum", shape.labels}};
    case Form::whole_number:
    case Form::real:
      return number_in(shape.range, shape.form == Form::whole_number);
    case Form::list:
    case Form::tuple:
      return list_schema(shape, own);
    case Form::map:
      return map_schema(shape, own);
    case Form::entries:
      return entries_schema(shape, own);
    case Form::one_of:
      return {{"anyOf", all_of_parts(shape, own)}};
  }
  return {};
}

Json number_of_form(Form form, double value) {
  return form == Form::whole_number ? Json(static_cast<std::int64_t>(value)) : Json(value);
}

Json standard_schema(const Shape& shape) {
  if (const auto* text = std::get_if<std::string>(&shape.standard)) return *text;
  if (const auto* numbers = std::get_if<std::vector<double>>(&shape.standard)) {
    Json all = Json::array();
    for (const double number : *numbers) all.push_back(number_of_form(shape.parts.front().form, number));
    return all;
  }
  const double number = std::get<double>(shape.standard);
  if (shape.form == Form::boolean) return number != 0.0;
  if (shape.form == Form::label) return shape.labels[static_cast<std::size_t>(number)];
  return number_of_form(shape.form, number);
}

}  // namespace

Json object_of(Json properties) {
  return object_of(std::move(properties), Json::array());
}

Json object_of(Json properties, Json required) {
  Json schema{{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

Json list_of(Json item, std::size_t min_items) {
  return {{"type", "array"}, {"items", std::move(item)}, {"minItems", min_items}};
}

Json number_in(const numerics::Interval& range, bool whole) {
  Json schema{{"type", whole ? "integer" : "number"}};
  const Form form = whole ? Form::whole_number : Form::real;
  if (std::isfinite(range.low))
    schema[range.low_included ? "minimum" : "exclusiveMinimum"] = number_of_form(form, range.low);
  if (std::isfinite(range.high))
    schema[range.high_included ? "maximum" : "exclusiveMaximum"] = number_of_form(form, range.high);
  return schema;
}

Json schema_of(const Shape& shape, const OwnSchema& own) {
  Json schema = form_schema(shape, own);
  Json forms = Json::array();
  if (!shape.none.empty()) forms.push_back({{"const", shape.none}});
  for (const auto& preset : shape.presets) forms.push_back({{"const", preset.first}});
  if (!forms.empty()) {
    forms.push_back(std::move(schema));
    schema = {{"anyOf", std::move(forms)}};
  }
  if (shape.standard.index() != 0) schema["default"] = standard_schema(shape);
  if (!shape.meaning.empty()) schema["description"] = shape.meaning;
  return schema;
}

}  // namespace zerocount::shapes
