#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount::yaml {

/// The candidate that is most similar to `name`: the one with the smallest Levenshtein distance, the first of
/// equals. Empty if there is no candidate or the distance is too large for a typing error.
std::string_view nearest_name(std::string_view name, std::span<const std::string> candidates);

/// Whether `name` may be a misspelling of `candidate`: at most one edit for every three letters of the
/// longer of the two.
bool is_near(std::string_view name, std::string_view candidate);

/// A place in a manifest or in an override of the command line. `source` must outlive it.
struct Place {
  std::string_view source;
  int line{0};    ///< line from 1; 0 if the source is a single line (an override)
  int column{0};  ///< column from 1, in bytes
};

struct Field;  // see scalars.hpp

/// Collects the errors of a manifest, to report all of them together.
class Problems {
 public:
  /// Adds an error at a place of the manifest. `path` is the dotted path of the key; `what` and `expected`
  /// are phrases without a full stop.
  void add(const Place& place, std::string_view path, std::string_view what, std::string_view expected);
  /// Adds a problem at the place of the field's value.
  void add(const Field& field, std::string_view what, std::string_view expected);

  /// Adds a missing key. Missing keys are reported after all other problems: the cause may be another
  /// problem, such as a misspelled key or a part that cannot be read.
  void add_missing(const Place& place, std::string_view path, std::string_view expected);
  void add_missing(const Place& place, std::string_view path, std::string_view what,
                   std::string_view expected);

  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }

  /// Throws if there are errors.
  /// @throws Failure (bad_input) with one line `file:line:column: path: what; expected` per problem, in the
  ///        order of the file, then those of overrides and the missing keys.
  void raise_if_any() const;

 private:
  struct Entry {
    Place place;
    std::string text;
    bool is_missing{false};  ///< the problem is that a key is missing
  };
  std::vector<Entry> entries_;
};

/// Text of a place, "file:line:column"; for an override, its source alone.
std::string place_text(const Place& place);

/// Message about a place in a manifest, "file:line:column: path: text".
std::string at_place(const Place& place, std::string_view path, std::string_view text);

/// `text` in single quotes, shortened if it is long, with visible control characters.
std::string in_quotes(std::string_view text);

}  // namespace zerocount::yaml
