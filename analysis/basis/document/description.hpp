#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/basis/document/content.hpp"
#include "analysis/basis/document/item.hpp"

namespace zerocount::document {

/// Maps a C++ type to the kind and the content of an item of an answer. Types of values are whole numbers,
/// floating-point numbers, estimates with bounds, Range, bool, text, and a variant of number and text. A
/// vector is a list. A map or a vector of pairs is a map. An empty optional is null.
template <class T>
struct ValueType;

template <>
struct ValueType<bool> {
  static void describe(Item& item) { item.kind = Kind::flag; }
  static Content content(bool value) { return {value}; }
};

template <std::integral T>
struct ValueType<T> {
  static void describe(Item& item) { item.kind = Kind::whole; }
  static Content content(T value) {
    using Whole = std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t>;
    return {static_cast<Whole>(value)};
  }
};

template <std::floating_point T>
struct ValueType<T> {
  static void describe(Item& item) { item.kind = Kind::number; }
  static Content content(T value) { return {static_cast<double>(value)}; }
};

/// Specialisation for an estimate with its bounds: any type with the members `value`, `low` and `high`.
template <class T>
requires requires(const T& of) {
  Bounded{of.value, of.low, of.high};
}
struct ValueType<T> {
  static void describe(Item& item) {
    item.kind = Kind::number;
    item.bounded = true;
  }
  static Content content(const T& of) { return {Bounded{of.value, of.low, of.high}}; }
};

/// Specialisation for a Range: an object with `low` and `high` in data, a text with the unit for people.
template <>
struct ValueType<Range> {
  static void describe(Item& item) {
    item.kind = Kind::object;
    item.nullable = true;
    if (item.heading.empty()) item.shown = Visibility::in_data;
    item.members = {in_data("low", "smallest over the trials", item.unit),
                    in_data("high", "largest over the trials", item.unit)};
    for (Item& end : item.members) end.kind = Kind::number;
  }
  static Content content(const Range& range) {
    return range.empty() ? Content{} : Content{Members{{Content{range.low}, Content{range.high}}}};
  }
};

template <class T>
requires std::convertible_to<T, std::string_view>
struct ValueType<T> {
  static void describe(Item& item) { item.kind = Kind::text; }
  static Content content(std::string_view value) { return {std::string(value)}; }
};

template <>
struct ValueType<std::variant<double, std::string>> {
  static void describe(Item& item) { item.kind = Kind::scalar; }
  static Content content(const std::variant<double, std::string>& value) {
    return std::visit([](const auto& one) { return Content{one}; }, value);
  }
};

template <class T>
struct ValueType<std::optional<T>> {
  static void describe(Item& item) {
    ValueType<T>::describe(item);
    item.nullable = true;
  }
  static Content content(const std::optional<T>& value) {
    return value ? ValueType<T>::content(*value) : Content{};
  }
};

/// The item that describes each element of a list or a map. It inherits unit, notation and words from the
/// item of the list or map.
template <class T>
Item element_of(const Item& whole) {
  Item element{.unit = whole.unit, .notation = whole.notation, .words = whole.words};
  ValueType<T>::describe(element);
  return element;
}

template <class T>
struct ValueType<std::vector<T>> {
  static void describe(Item& item) {
    item.kind = Kind::list;
    item.members = {element_of<T>(item)};
  }
  static Content content(const std::vector<T>& values) {
    List list;
    for (auto&& value : values) list.values.push_back(ValueType<T>::content(value));
    return {std::move(list)};
  }
};

template <class T>
struct ValueType<std::vector<std::pair<std::string, T>>> {
  static void describe(Item& item) {
    item.kind = Kind::map;
    item.members = {element_of<T>(item)};
  }
  static Content content(const auto& values) {
    Named named;
    for (const auto& [name, value] : values) named.values.emplace_back(name, ValueType<T>::content(value));
    return {std::move(named)};
  }
};

template <class T>
struct ValueType<std::map<std::string, T>> : ValueType<std::vector<std::pair<std::string, T>>> {};

/// Pointer to the object that an item describes: looks through pointers and optional values. Null if there is
/// no object; the item then has no content.
template <class T>
const T* subject_in(const T& subject) {
  return &subject;
}
template <class T>
const T* subject_in(const T* subject) {
  return subject;
}
template <class T>
const T* subject_in(const std::optional<T>& subject) {
  return subject ? &*subject : nullptr;
}

/// The items of an object, a row or an answer, with the functions that read the content of each item from a
/// `Row`. All formats show the items in the order in which they were added.
template <class Row>
class Description {
 public:
  using ContentOf = std::function<Content(const Row&, Audience)>;

  /// Adds an item with a single value, a list or a map. `get` returns it from a Row; the kind of the item
  /// follows from the type (ValueType).
  template <class Get>
  Description& value(Item item, Get get) {
    using Type = std::remove_cvref_t<std::invoke_result_t<Get, const Row&>>;
    ValueType<Type>::describe(item);
    const std::string unit = item.unit;
    add(std::move(item),
        [get](const Row& row, Audience) { return ValueType<Type>::content(std::invoke(get, row)); });
    if constexpr (std::is_same_v<Type, Range>)
      shown_as([get, unit](const Row& row) { return range_text(std::invoke(get, row), unit); });
    return *this;
  }

  /// Shows people the value that `get` returns in place of the item that was added last. A text is shown
  /// without the unit of the item, unless the item is Item::numeric.
  template <class Get>
  Description& shown_as(Get get) {
    using Value = ValueType<std::remove_cvref_t<std::invoke_result_t<Get, const Row&>>>;
    Item shown;
    Value::describe(shown);
    items_.back().kind_for_people = shown.kind;
    contents_.back() = [data = std::move(contents_.back()), get = std::move(get)](const Row& row,
                                                                                  Audience audience) {
      if (audience == Audience::people) return Value::content(std::invoke(get, row));
      if (audience != Audience::all) return data(row, audience);
      return Content{std::make_shared<const Twofold>(data_in(data(row, audience)),
                                                     Value::content(std::invoke(get, row)))};
    };
    return *this;
  }

  /// Shows people the item that was added last only in those rows for which `is_worth` returns true. Data
  /// formats always show it.
  template <class IsWorth>
  Description& shown_where(IsWorth is_worth) {
    contents_.back() = [data = std::move(contents_.back()), is_worth](const Row& row, Audience audience) {
      if (std::invoke(is_worth, row) || audience == Audience::json || audience == Audience::csv)
        return data(row, audience);
      if (audience == Audience::people) return Content{};
      return Content{std::make_shared<const Twofold>(data(row, audience), Content{})};
    };
    return *this;
  }

  /// Adds an item that is an object with the items of `parts`. `get` returns a Part from a Row, an optional
  /// Part, or a pointer to one.
  template <class Part, class Get>
  Description& object(Item item, Description<Part> parts, Get get) {
    item.kind = Kind::object;
    item.nullable = !std::is_same_v<std::remove_cvref_t<std::invoke_result_t<Get, const Row&>>, Part>;
    item.members = parts.items();
    return add(
        std::move(item),
        [parts = std::move(parts), get = std::move(get)](const Row& row, Audience audience) -> Content {
          auto&& found = std::invoke(get, row);
          const Part* const part = subject_in(found);
          return part == nullptr ? Content{} : Content{parts.members_of(*part, audience)};
        });
  }

  /// Adds an item that is a table with the items of `columns`. `get` returns a range of Parts from a Row, one
  /// per row of the table.
  template <class Part, class Get>
  Description& table(Item item, Description<Part> columns, Get get) {
    item.kind = Kind::table;
    return add_rows(std::move(item), std::move(columns), std::move(get));
  }

  /// Adds sections, each with the items of `parts`: a list of objects in JSON, one section below the other
  /// for people. `get` returns a range of Parts from a Row, one per section.
  template <class Part, class Get>
  Description& sections(Item item, Description<Part> parts, Get get) {
    item.kind = Kind::sections;
    return add_rows(std::move(item), std::move(parts), std::move(get));
  }

  /// Adds the items of `parts` one by one, as items of this description itself. `get` returns a Part from a
  /// Row, an optional Part, or a pointer to one; without a Part the items are empty.
  template <class Part, class Get>
  Description& include(const Description<Part>& parts, Get get) {
    for (std::size_t i = 0; i < parts.items().size(); ++i) {
      Item item = parts.items()[i];
      item.nullable =
          item.nullable || !std::is_same_v<std::remove_cvref_t<std::invoke_result_t<Get, const Row&>>, Part>;
      add(std::move(item),
          [content = parts.content_of(i), get](const Row& row, Audience audience) -> Content {
            auto&& found = std::invoke(get, row);
            const Part* const part = subject_in(found);
            return part == nullptr ? Content{} : content(*part, audience);
          });
    }
    return *this;
  }

  /// Adds the headline: the answer in one sentence, which `get` returns. Each answer has exactly one
  /// headline.
  template <class Get>
  Description& headline(Get get) {
    return add_text({.key = "headline", .meaning = "the answer in one sentence", .kind = Kind::headline},
                    std::move(get));
  }

  /// Adds the title of a section, for people only. `get` returns its text.
  template <class Get>
  Description& title(Get get) {
    return add_text({.shown = Visibility::to_people, .kind = Kind::title}, std::move(get));
  }

  /// Adds sentences for people, each on a line of its own. `get` returns their text from a Row; none are
  /// shown if it is empty.
  template <class Get>
  Description& sentence(Get get) {
    return add_text({.shown = Visibility::to_people, .kind = Kind::sentence}, std::move(get));
  }

  /// Adds figures, for people only. `get` returns a vector of Figure from a Row.
  template <class Get>
  Description& figures(Get get) {
    return add({.shown = Visibility::to_people, .kind = Kind::figure},
               [get = std::move(get)](const Row& row, Audience) -> Content {
                 List list;
                 for (Figure& figure : std::invoke(get, row))
                   list.values.push_back({std::make_shared<const Figure>(std::move(figure))});
                 return {std::move(list)};
               });
  }

  const std::vector<Item>& items() const { return items_; }
  const ContentOf& content_of(std::size_t item) const { return contents_[item]; }

  /// The contents of all items for `row`, in their order. Items that the audience is not shown are empty.
  Members members_of(const Row& row, Audience audience = Audience::all) const {
    Members members;
    members.contents.reserve(contents_.size());
    for (std::size_t i = 0; i < items_.size(); ++i)
      members.contents.push_back(is_shown(items_[i].shown, audience) ? contents_[i](row, audience)
                                                                     : Content{});
    return members;
  }

 private:
  Description& add(Item item, ContentOf content) {
    const bool is_value = item.kind != Kind::object && item.kind != Kind::table &&
                          item.kind != Kind::sections && item.kind != Kind::headline;
    if (item.shown == Visibility::everywhere && item.key.empty()) item.shown = Visibility::to_people;
    if (item.shown == Visibility::everywhere && item.heading.empty() && is_value)
      item.shown = Visibility::in_data;
    items_.push_back(std::move(item));
    contents_.push_back(std::move(content));
    return *this;
  }

  template <class Part, class Get>
  Description& add_rows(Item item, Description<Part> parts, Get get) {
    item.members = parts.items();
    const bool optional = item.optional;
    return add(std::move(item),
               [parts = std::move(parts), get = std::move(get), optional](const Row& row,
                                                                          Audience audience) -> Content {
                 Rows rows;
                 auto&& found = std::invoke(get, row);
                 for (const Part& part : found) rows.rows.push_back(parts.members_of(part, audience));
                 if (optional && rows.rows.empty()) return {};
                 return {std::move(rows)};
               });
  }

  template <class Get>
  Description& add_text(Item item, Get get) {
    return add(std::move(item), [get = std::move(get)](const Row& row, Audience) -> Content {
      std::string sentence = std::invoke(get, row);
      return sentence.empty() ? Content{} : Content{std::move(sentence)};
    });
  }

  std::vector<Item> items_;
  std::vector<ContentOf> contents_;
};

}  // namespace zerocount::document
