#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/numerics/interval.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::yaml {

/// A node of a manifest's YAML tree, and its dotted path in the manifest.
struct Field {
  const YamlNode* node{nullptr};
  std::string path;
};

Field entry_of(const Field& map, const YamlEntry& entry);
Field item_of(const Field& list, std::size_t index);
/// The value of `key`; empty if `map` is not a map or does not have the key.
std::optional<Field> find_field(const Field& map, std::string_view key);

// Each function returns the value, or reports an error to `problems` and returns nothing. Nothing is
// converted: a quoted number is a text, and forms with a special meaning in YAML 1.1 (`010`, `1_000`, `1:30`,
// `no`) are refused.

/// The field as a finite decimal number inside `range`; nothing, with an entry in `problems`, for other
/// fields.
/// @param or_else alternative to a number, for the message
std::optional<double> read_real(const Field& field, const numerics::Interval& range, Problems& problems,
                                std::string_view or_else = {});

/// A whole number, written without point or exponent, from `low` to `high`.
/// @param or_else as for read_real
std::optional<std::int64_t> read_whole(const Field& field, std::int64_t low, std::int64_t high,
                                       Problems& problems, std::string_view or_else = {});

/// The field as a whole number from 0 to 2⁶⁴ − 1; empty after an error, which is reported.
std::optional<std::uint64_t> read_seed(const Field& field, Problems& problems);

/// The field as `true` or `false`; empty after an error, which is reported.
std::optional<bool> read_bool(const Field& field, Problems& problems);

/// Index in `labels` of the field's text; empty, and reported, if it is not among them.
std::optional<std::size_t> read_label(const Field& field, std::span<const std::string_view> labels,
                                      Problems& problems);

/// The field as a text; empty after an error, which is reported. A text that YAML would read as a number, a
/// boolean or null must be quoted.
std::optional<std::string> read_text(const Field& field, Problems& problems);

/// A text on one line, such as a name or a path. Empty after an error, which is reported.
std::optional<std::string> read_line(const Field& field, Problems& problems);

/// Reports that `field` has the wrong type, and describes its value.
void add_wrong_type(const Field& field, const std::string& expected, Problems& problems);

/// Whether the field is a map; reports an error if it is not.
bool check_map(const Field& field, const std::string& expected, Problems& problems);
bool check_list(const Field& field, const std::string& expected, Problems& problems);

}  // namespace zerocount::yaml
