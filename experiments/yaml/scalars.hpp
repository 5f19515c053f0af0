#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/numerics/interval.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount {

/// A node and the dotted path under which the manifest knows it.
struct Field {
  const YamlNode* node{nullptr};
  std::string path;
};

Field entry_of(const Field& map, const YamlEntry& entry);
Field item_of(const Field& list, std::size_t index);

// Each of these returns the value, or reports to `problems` what is wrong and returns nothing. Nothing is
// converted: a quoted number is a text, and what YAML 1.1 would make of `010`, `1_000`, `1:30`, `no` is
// refused.

/// A finite decimal number inside `range`.
std::optional<double> read_real(const Field& field, const Interval& range, Problems& problems);

/// A whole number, written without point or exponent, from `low` to `high`.
std::optional<std::int64_t> read_whole(const Field& field, std::int64_t low, std::int64_t high,
                                       Problems& problems);

/// A whole number from 0 to 2⁶⁴ − 1.
std::optional<std::uint64_t> read_seed(const Field& field, Problems& problems);

/// `true` or `false`.
std::optional<bool> read_truth(const Field& field, Problems& problems);

/// Which of these labels the field is, from 0 on.
std::optional<std::size_t> read_label(const Field& field, std::span<const std::string_view> labels,
                                      Problems& problems);

/// A text; one that YAML would take for a number, a truth value or nothing must be quoted.
std::optional<std::string> read_text(const Field& field, Problems& problems);

/// Says that `field` is not what was expected; what it is, is told in words.
void add_wrong_type(const Field& field, const std::string& expected, Problems& problems);

/// Whether the field is a map (a list); reports it where it is not.
bool check_map(const Field& field, const std::string& expected, Problems& problems);
bool check_list(const Field& field, const std::string& expected, Problems& problems);

}  // namespace zerocount
