#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace zerocount::document {

struct Figure;  // figure.hpp

/// A number with bounds, all in the unit of the item.
struct Bounded {
  double value;
  double low;
  double high;
};

/// A value with bounds, which have the members `low` and `high`.
Bounded bounded(double value, const auto& bounds) {
  return {value, bounds.low, bounds.high};
}

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

/// The content of one item; std::monostate if there is none.
struct Content {
  std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, Bounded, std::string, Members, List,
               Named, Rows, std::shared_ptr<const Figure>>
      value{};
  std::shared_ptr<const Content> for_people{};  ///< where people are shown something else

  bool is_empty() const { return value.index() == 0; }
};

}  // namespace zerocount::document
