#include <cmath>

#include <nlohmann/json.hpp>

#include "analysis/document/answer.hpp"

namespace zerocount::document {
namespace {

using Json = nlohmann::ordered_json;

Json number_json(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json content_json(const Item& item, const Content& content);

void add_member(Json& object, const Item& item, const Content& content) {
  if (!is_shown(item.shown, Audience::json) || (item.optional && content.is_empty())) return;
  if (item.bounded) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto* const found = std::get_if<Bounded>(&content.value);
    const Bounded number = found == nullptr ? Bounded{unknown, unknown, unknown} : *found;
    object[item.key] = number_json(number.value);
    object[item.key + "_low"] = number_json(number.low);
    object[item.key + "_high"] = number_json(number.high);
    return;
  }
  object[item.key] = content_json(item, content);
}

Json members_json(const std::vector<Item>& items, const Members& members) {
  Json object = Json::object();
  for (std::size_t i = 0; i < items.size(); ++i) add_member(object, items[i], members.contents[i]);
  return object;
}

/// The JSON of each alternative of Content.
struct ContentJson {
  const Item& item;

  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(bool value) const { return value; }
  Json operator()(std::int64_t value) const { return value; }
  Json operator()(std::uint64_t value) const { return value; }
  Json operator()(double value) const { return number_json(value); }
  Json operator()(const Bounded& value) const { return number_json(value.value); }
  Json operator()(const std::string& value) const { return value; }
  Json operator()(const Members& members) const { return members_json(item.members, members); }
  Json operator()(const List& list) const {
    Json array = Json::array();
    for (const Content& value : list.values) array.push_back(content_json(item.members[0], value));
    return array;
  }
  Json operator()(const Named& named) const {
    Json object = Json::object();
    for (const auto& [name, value] : named.values) object[name] = content_json(item.members[0], value);
    return object;
  }
  Json operator()(const Rows& rows) const {
    Json array = Json::array();
    for (const Members& row : rows.rows) array.push_back(members_json(item.members, row));
    return array;
  }
  Json operator()(const std::shared_ptr<const Figure>&) const { return nullptr; }
};

Json content_json(const Item& item, const Content& content) {
  return std::visit(ContentJson{item}, content.value);
}

}  // namespace

Json json(const std::vector<Item>& items, const Members& contents) {
  return members_json(items, contents);
}

Json json(const Answer& answer) {
  Json json{{"answer", answer.type.name}, {"version", answer.type.version}};
  json.update(members_json(answer.type.items, answer.contents));
  return json;
}

}  // namespace zerocount::document
