#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/numerics/interval.hpp"
#include "core/text/text.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount::keys {
struct Reading;  // keys/values.hpp: where the values of a manifest are stored
}

namespace zerocount::shapes {

using keys::Reading;

/// The form of a key that is not a parameter, or of a value in it: it cannot be drawn or swept. The reader
/// with its messages (read), the JSON Schema (shape_schema.hpp) and the line of `zerocount parameters` all
/// follow from the shape. What depends on other keys is checked where those are known.
struct Shape {
  enum class Form : std::uint8_t {
    own,  ///< values of parameters: reader and schema know their table
    text,
    line,  ///< a text on one line that is not blank: a name, a path
    word,  ///< a line without blanks
    seed,  ///< a whole number from 0 to 2⁶⁴ − 1
    boolean,
    label,
    whole_number,
    real,
    list,     ///< of any number of values of one shape
    tuple,    ///< a list of values, each of its own shape
    map,      ///< of known keys
    entries,  ///< a map from names or paths to values of one shape
    one_of    ///< shapes of different kinds: a single value, a list, a map
  };
  enum class Order : std::uint8_t { any, distinct, rising };
  using Standard = std::variant<std::monostate, double, std::string, std::vector<double>>;

  std::string_view name{};     ///< dotted path; last part of it for a key of a map
  std::string_view meaning{};  ///< empty for a key of a map, which that of the map explains
  std::string_view
      if_missing{};  ///< what a manifest without a required key lacks; empty: the key is optional
  std::string_view in_its_place{};  ///< a key of the same map that may stand in place of a required one
  Form form{Form::own};
  numerics::Interval range{};                  ///< of a number; of a whole number closed
  std::span<const std::string_view> labels{};  ///< of a label, in the order of its enumeration
  std::string_view none{};                     ///< word in place of the number or of all numbers of the map
  /// Words in place of a map, and what each stores.
  std::vector<std::pair<std::string_view, void (*)(Reading&)>> presets{};
  std::string expected{};      ///< what a message says where anything else stands; numbers and labels know it
  std::vector<Shape> parts{};  ///< keys, values of a tuple, alternatives; or the one shape of all values
  std::size_t min_count{0};    ///< of a list, or of entries
  std::size_t max_count{std::numeric_limits<std::size_t>::max()};
  Order order{Order::any};              ///< of the numbers of a list; of tuples their first numbers
  std::string_view entry{};             ///< noun for one of the entries
  bool named{true};                     ///< the keys of entries are names, each on one line
  std::vector<std::string> patterns{};  ///< regular expressions of all keys of entries; empty: any key
  /// Makes the place of an entry's value before that is read.
  std::function<void(Reading&, const std::string& entry)> add{};
  /// Stores a value of this shape; null: the word `none`. Without it, code takes the value where it is used.
  std::function<void(Reading&, const Shape&, const yaml::Field*)> set{};
  Standard standard{};  ///< what holds without the key

  bool required() const { return !if_missing.empty(); }
};

/// `key`, which has the name, the meaning and what lacks without it, with a form and its parts.
Shape of(Shape::Form form, Shape key = {}, std::string expected = "", std::vector<Shape> parts = {});

Shape whole(std::int64_t low, std::int64_t high, Shape key = {});
Shape real(const numerics::Interval& range, Shape key = {});

/// Lets the whole numbers in a list of the map be at most `highest`, where other keys determine it.
void limit_items(Shape& map, std::string_view list, std::int64_t highest);

/// Reports where the value in `field` departs from the shape; true if nowhere. What has a place to be stored
/// is stored in `reading`, unless that is null; of a faulty value its sound parts.
bool read(const yaml::Field& field, const Shape& shape, yaml::Problems& problems, Reading* reading = nullptr);

/// Reads the keys of `map` in the same way, and reports those that are missing. The caller reports unknown
/// ones.
void read_keys(const yaml::Field& map, std::span<const Shape> keys, yaml::Problems& problems,
               Reading* reading);

// Values of a field that has its shape; NaN, 0 or none of another one, which is reported.

double number_of(const yaml::Field& field);
template <class Whole = std::int64_t>
Whole whole_of(const yaml::Field& field) {
  return text::parse_number<Whole>(field.node->text).value_or(0);
}
std::vector<yaml::Field> items_of(const yaml::Field& list);

}  // namespace zerocount::shapes
