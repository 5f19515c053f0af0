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

/// A number with bounds, all in the unit of the item.
struct Bounded {
  double value;
  double low;
  double high;
};

/// A Bounded from a value and its bounds. @param bounds any type with members `low` and `high`
Bounded bounded(double value, const auto& bounds) {
  return {value, bounds.low, bounds.high};
}

/// Range of a quantity over trials, in the unit of the item. Adding NaN does not change the range.
struct Range {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
};

/// "0.5 … 2 Hz"; one number if the ends are equal. Empty for an empty range.
std::optional<std::string> range_text(const Range& range, const std::string& unit = {});

struct Content;

/// The contents of the members of an item, in their order.
struct Members {
  std::vector<Content> contents;
};

/// The values of a list.
struct List {
  std::vector<Content> values;
};

/// Values by name, in their order.
struct Named {
  std::vector<std::pair<std::string, Content>> values;
};

/// The rows of a table.
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

/// A content for data, and another that people are shown in its place. Content holds it by pointer, so that a
/// Content stays as small as a text: an answer holds one for each value.
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
