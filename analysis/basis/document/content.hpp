#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace zerocount::document {

struct Figure;   // figure.hpp
struct Twofold;  // below

/// A number with a lower and an upper bound, all in the unit of the item that describes it.
struct Bounded {
  double value;
  double low;
  double high;
};

/// The number `value` with the members `low` and `high` of `bounds`.
/// @param bounds any type with members `low` and `high`
Bounded bounded(double value, const auto& bounds) {
  return {value, bounds.low, bounds.high};
}

/// Range (minimum to maximum) of a quantity over trials, in the unit of the item that describes it. Adding
/// NaN does not change the range.
struct Range {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
};

/// Text of a range: "0.5 … 2 Hz"; one number if the ends are equal. Null for a range without values.
std::optional<std::string> range_text(const Range& range, const std::string& unit = {});

struct Content;

/// The contents of the members of an object (or of the columns of a row), one for each item, in the order of
/// the items.
struct Members {
  std::vector<Content> contents;
};

/// The values of a list, as the content of one item.
struct List {
  std::vector<Content> values;
};

/// Values by name, in their order, as the content of one item.
struct Named {
  std::vector<std::pair<std::string, Content>> values;
};

/// The rows of a table, as the content of one item.
struct Rows {
  std::vector<Members> rows;
};

/// The content of one item; std::monostate if the item has no content.
struct Content {
  std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, Bounded, std::string, Members, List,
               Named, Rows, std::shared_ptr<const Figure>, std::shared_ptr<const Twofold>>
      value{};

  bool is_empty() const { return value.index() == 0; }
};

/// A content with two forms: one for data formats, and another that people are shown in its place. Content
/// holds it by pointer, so that a Content stays as small as a text: an answer holds one for each value.
struct Twofold {
  Content data;
  Content shown;
};

inline const Content& data_in(const Content& content) {
  const auto* const twofold = std::get_if<std::shared_ptr<const Twofold>>(&content.value);
  return twofold == nullptr ? content : (*twofold)->data;
}

inline const Content& shown_in(const Content& content) {
  const auto* const twofold = std::get_if<std::shared_ptr<const Twofold>>(&content.value);
  return twofold == nullptr ? content : (*twofold)->shown;
}

}  // namespace zerocount::document
