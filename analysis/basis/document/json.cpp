#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/text/report_json.hpp"

namespace zerocount::document {
namespace {

using Json = nlohmann::ordered_json;
using TakeText = std::function<void(std::string_view)>;

/// Writes an answer as JSON in pieces, with the text that nlohmann's dump() would give. A tree of an answer
/// with 10⁵ rows would take several times the memory of its text.
class JsonWriter {
 public:
  JsonWriter(int indent, const TakeText& take) : indent_(indent), take_(take) {}

  void object(const std::vector<Item>& items, const Members& members) {
    open('{');
    add_members(items, members);
    close('}');
  }

  /// Writes the answer without its last line break.
  void answer(const Answer& answer) {
    open('{');
    key("answer");
    text(answer.type.name);
    key("version");
    text_ += std::to_string(answer.type.version);
    add_members(answer.type.items, answer.contents);
    close('}');
  }

  void finish() {
    take_(text_);
    text_.clear();
  }

  // The JSON of each alternative of Content, of the item that is being written.

  void operator()(std::monostate) { text_ += "null"; }
  void operator()(bool value) { text_ += value ? "true" : "false"; }
  void operator()(std::int64_t value) { text_ += std::to_string(value); }
  void operator()(std::uint64_t value) { text_ += std::to_string(value); }
  void operator()(double value) { text_ += std::isfinite(value) ? Json(value).dump() : "null"; }
  void operator()(const Bounded& value) { (*this)(value.value); }
  void operator()(const std::string& value) { text(value); }
  void operator()(const std::shared_ptr<const Figure>&) { text_ += "null"; }
  void operator()(const std::shared_ptr<const Twofold>& twofold) { content(*item_, twofold->data); }
  void operator()(const Members& members) { object(item_->members, members); }
  void operator()(const List& list) {
    const Item& element = item_->members[0];
    open('[');
    for (const Content& one : list.values) {
      next();
      content(element, one);
    }
    close(']');
  }
  void operator()(const Named& named) {
    const Item& element = item_->members[0];
    open('{');
    for (const auto& [name, one] : named.values) {
      key(name);
      content(element, one);
    }
    close('}');
  }
  void operator()(const Rows& rows) {
    const std::vector<Item>& columns = item_->members;
    open('[');
    for (const Members& row : rows.rows) {
      next();
      object(columns, row);
    }
    close(']');
  }

 private:
  void add_members(const std::vector<Item>& items, const Members& members) {
    for (std::size_t i = 0; i < items.size(); ++i) add_member(items[i], members.contents[i]);
  }

  void add_member(const Item& item, const Content& value) {
    const Content& data = data_in(value);
    if (!is_shown(item.shown, Audience::json) || (item.optional && data.is_empty())) return;
    if (!item.bounded) {
      key(item.key);
      content(item, data);
      return;
    }
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto* const found = std::get_if<Bounded>(&data.value);
    const Bounded number = found == nullptr ? Bounded{unknown, unknown, unknown} : *found;
    key(item.key);
    (*this)(number.value);
    key(item.key + "_low");
    (*this)(number.low);
    key(item.key + "_high");
    (*this)(number.high);
  }

  void content(const Item& item, const Content& value) {
    item_ = &item;
    std::visit(*this, value.value);
  }

  void key(const std::string& name) {
    next();
    text(name);
    text_ += indent_ < 0 ? ":" : ": ";
  }

  void text(const std::string& value) {
    const bool plain =
        std::ranges::all_of(value, [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; });
    text_ += plain ? '"' + value + '"' : Json(value).dump(-1, ' ', false, Json::error_handler_t::replace);
  }

  void open(char bracket) {
    text_ += bracket;
    ++depth_;
    is_empty_ = true;
  }

  /// Begins a member of an object or an element of a list: writes the comma and the line break before it.
  void next() {
    constexpr std::size_t piece = 1 << 16;
    if (!is_empty_) text_ += ',';
    if (text_.size() >= piece) finish();
    line();
    is_empty_ = false;
  }

  void close(char bracket) {
    --depth_;
    if (!is_empty_) line();
    text_ += bracket;
    is_empty_ = false;
  }

  void line() {
    if (indent_ < 0) return;
    text_ += '\n';
    text_.append(static_cast<std::size_t>(indent_ * depth_), ' ');
  }

  int indent_;
  const TakeText& take_;
  const Item* item_{nullptr};
  std::string text_;  ///< Text that has not been passed to `take_` yet.
  int depth_{0};
  bool is_empty_{true};  ///< Whether the object or list that was opened last has no member yet.
};

}  // namespace

void write_json(const Answer& answer, int indent, const std::function<void(std::string_view)>& take) {
  JsonWriter writer(indent, take);
  writer.answer(answer);
  writer.finish();
  take("\n");
}

std::string json_text(const Answer& answer, int indent) {
  std::string text;
  write_json(answer, indent, [&](std::string_view piece) { text += piece; });
  return text;
}

Json json(const std::vector<Item>& items, const Members& contents) {
  std::string text;
  const TakeText take = [&](std::string_view piece) { text += piece; };
  JsonWriter writer(text::one_line, take);
  writer.object(items, contents);
  writer.finish();
  return Json::parse(text);
}

Json json(const Answer& answer) {
  return Json::parse(json_text(answer, text::one_line));
}

}  // namespace zerocount::document
