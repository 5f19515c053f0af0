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
struct StudyDraft;  // keys/values.hpp: where the values of a manifest are stored
}

namespace zerocount::shapes {

using keys::StudyDraft;

/// The allowed form of the value of a manifest key that is not a parameter, or of a value inside such a key.
/// Such a value cannot be drawn or swept. The reader with its messages (read), the JSON Schema
/// (shape_schema.hpp) and the line of `zerocount parameters` are all derived from the shape. Conditions that
/// involve other keys are checked elsewhere, where those are known.
struct Shape {
  enum class Form : std::uint8_t {
    own,  ///< values of parameters of a trial; the table of parameters describes them, not the shape
    text,
    line,  ///< a text on one line with at least one character that is not blank: a name, a path
    word,  ///< a text on one line without blanks
    seed,  ///< a whole number from 0 to 2⁶⁴ − 1
    boolean,
    label,
    whole_number,
    real,
    list,     ///< a list of any number of values that all have one shape
    tuple,    ///< a list with a fixed number of values, each of its own shape
    map,      ///< a map with a fixed set of keys
    entries,  ///< a map with any names or dotted paths as keys, to values of one shape
    one_of    ///< one of several shapes of different kinds: a single value, a list, a map
  };
  enum class Order : std::uint8_t { any, distinct, rising };
  using Standard = std::variant<std::monostate, double, std::string, std::vector<double>>;

  std::string_view name{};  ///< dotted path of the key; for a key of a map its last part only
  /// Description of the key; empty for a key of a map: the map's meaning explains it.
  std::string_view meaning{};
  /// Phrase for the message if this required key is missing: what the manifest then lacks. Empty: the key is
  /// optional.
  std::string_view if_missing{};
  /// Another key of the same map that may be given in place of this required key.
  std::string_view in_its_place{};
  Form form{Form::own};
  numerics::Interval range{};  ///< allowed range of a number; a whole number may be equal to both ends
  std::span<const std::string_view> labels{};  ///< allowed labels, in the order of the enumeration
  /// Word that may stand in place of the number, or of all numbers of the map; empty: none.
  std::string_view none{};
  /// Words that may stand in place of a map, each with a function that stores the values that the word means.
  std::vector<std::pair<std::string_view, void (*)(StudyDraft&)>> presets{};
  /// Text after "expected" in messages about a wrong value; empty for numbers and labels, whose text follows
  /// from `range` or `labels`.
  std::string expected{};
  /// Shapes of the keys of a map, of the values of a tuple, or of the alternatives; for a list or entries,
  /// the one shape of all values.
  std::vector<Shape> parts{};
  std::size_t min_count{0};  ///< minimum length of a list, or minimum number of entries of a map
  /// Maximum length of a list, or maximum number of entries of a map.
  std::size_t max_count{std::numeric_limits<std::size_t>::max()};
  /// Required order of the numbers in a list, or of the first numbers of its tuples.
  Order order{Order::any};
  std::string_view entry{};  ///< noun for one entry of a map from names to values, for messages
  bool named{true};          ///< for a map with names as keys: each name stands on one line
  /// For a map with any keys: regular expressions of the allowed keys; empty: any key is allowed.
  std::vector<std::string> patterns{};
  /// Creates the object in which the value of an entry (of a map from names to values) is stored, before that
  /// value is read.
  std::function<void(StudyDraft&, const std::string& entry)> add{};
  /// Stores a value that was read with this shape; a null field stands for the word `none`. Empty: other code
  /// reads the value where it is needed.
  std::function<void(StudyDraft&, const Shape&, const yaml::Field*)> set{};
  Standard standard{};  ///< default if the key is absent

  bool required() const { return !if_missing.empty(); }
};

/// A copy of the shape `key` (with its name, its meaning and its text `if_missing`), which gets this form and
/// the shapes of its parts.
Shape of(Shape::Form form, Shape key = {}, std::string expected = "", std::vector<Shape> parts = {});

Shape whole(std::int64_t low, std::int64_t high, Shape key = {});
Shape real(const numerics::Interval& range, Shape key = {});

/// Sets the maximum of the whole numbers in a list under one key of the map, for a maximum that depends on
/// other keys.
/// @param list name of the list's key
/// @param highest maximum; below 0 counts as 0
void limit_items(Shape& map, std::string_view list, std::int64_t highest);

/// Checks the value in `field` against the shape, and reports every deviation. Values with a setter are
/// stored in `draft`, unless it is null; of a faulty value, the valid parts are stored.
/// @return whether the value is valid
bool read(const yaml::Field& field, const Shape& shape, yaml::Problems& problems,
          StudyDraft* draft = nullptr);

/// Reads the keys of `map` as read() does, and reports required keys that are missing. The caller must report
/// unknown keys.
void read_keys(const yaml::Field& map, std::span<const Shape> keys, yaml::Problems& problems,
               StudyDraft* draft);

// Values of a field that has its shape; NaN, 0 or none of another one, which is reported.

double number_of(const yaml::Field& field);
template <class Whole = std::int64_t>
Whole whole_of(const yaml::Field& field) {
  return text::parse_number<Whole>(field.node->text).value_or(0);
}
std::vector<yaml::Field> items_of(const yaml::Field& list);

}  // namespace zerocount::shapes
