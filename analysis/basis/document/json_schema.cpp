#include <nlohmann/json.hpp>

#include "analysis/basis/document/answer.hpp"

namespace zerocount::document {
namespace {

using Json = nlohmann::ordered_json;

Json item_schema(const Item& item);

void add_property(Json& object, const Item& item) {
  if (!is_shown(item.shown, Audience::json)) return;
  const auto add = [&](const std::string& key, Json schema) {
    object["properties"][key] = std::move(schema);
    if (!item.optional) object["required"].push_back(key);
  };
  add(item.key, item_schema(item));
  if (!item.bounded) return;
  for (const char* const side : {"low", "high"}) {
    Json schema{{"type", {"number", "null"}}};
    schema["description"] = side == std::string("low") ? "lower bound" : "upper bound";
    if (!item.unit.empty()) schema["unit"] = item.unit;
    add(item.key + "_" + side, std::move(schema));
  }
}

Json object_schema(const std::vector<Item>& items) {
  Json schema{{"type", "object"},
              {"properties", Json::object()},
              {"required", Json::array()},
              {"additionalProperties", false}};
  for (const Item& item : items) add_property(schema, item);
  return schema;
}

/// The JSON Schema of the item's content, by its kind. It does not allow null; Item::nullable is applied
/// later.
Json kind_schema(const Item& item) {
  switch (item.kind) {
    case Kind::flag:
      return {{"type", "boolean"}};
    case Kind::whole:
      return {{"type", "integer"}};
    case Kind::number:
      return {{"type", Json::array({"number", "null"})}};
    case Kind::scalar:
      return {{"type", Json::array({"number", "string", "null"})}};
    case Kind::list:
      return {{"type", "array"}, {"items", item_schema(item.members[0])}};
    case Kind::map:
      return {{"type", "object"}, {"additionalProperties", item_schema(item.members[0])}};
    case Kind::object:
      if (item.free_keys)
        return {{"type", "object"}, {"additionalProperties", item_schema(item.members.at(0))}};
      return object_schema(item.members);
    case Kind::table:
    case Kind::sections:
      return {{"type", "array"}, {"items", object_schema(item.members)}};
    case Kind::text:
      if (!item.words.empty()) return {{"enum", item.words}};
      break;
    case Kind::headline:
    case Kind::title:
    case Kind::sentence:
    case Kind::figure:
      break;
  }
  return {{"type", "string"}};
}

void allow_null(Json& schema) {
  if (schema.contains("enum")) {
    schema["enum"].push_back(nullptr);
  } else if (schema["type"].is_string()) {
    schema["type"] = Json::array({schema["type"], "null"});
  }
}

Json item_schema(const Item& item) {
  Json schema = kind_schema(item);
  if (item.nullable) allow_null(schema);
  if (const std::string& meaning = item.meaning.empty() ? item.heading : item.meaning; !meaning.empty())
    schema["description"] = meaning;
  if (!item.unit.empty()) schema["unit"] = item.unit;
  return schema;
}

}  // namespace

Json json_schema(const AnswerType& type) {
  Json schema = object_schema(type.items);
  Json properties{{"answer", {{"const", type.name}}}, {"version", {{"const", type.version}}}};
  properties.update(schema["properties"]);
  schema["properties"] = std::move(properties);
  Json required = Json::array({"answer", "version"});
  for (const Json& key : schema["required"]) required.push_back(key);
  schema["required"] = std::move(required);
  schema["description"] = type.meaning;
  return schema;
}

Json json_schema(const std::vector<AnswerType>& types) {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "answers of zerocount"},
              {"oneOf", Json::array()},
              {"$defs", Json::object()}};
  for (const AnswerType& type : types) {
    schema["oneOf"].push_back({{"$ref", "#/$defs/" + type.name}});
    schema["$defs"][type.name] = json_schema(type);
  }
  return schema;
}

}  // namespace zerocount::document
