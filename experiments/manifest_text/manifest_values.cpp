#include "experiments/manifest_text/manifest_values.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/text/number_text.hpp"
#include "experiments/manifest_text/overrides.hpp"

namespace zerocount::manifest_text {
namespace {

/// Maps whose keys are numbered in the order in which they are written.
constexpr std::array<std::string_view, 4> ordered_maps{"sweep.grid", "sweep.cases", "conditions", "goals"};
constexpr std::size_t max_differences_listed = 5;

void collect(const yaml::YamlNode& node, const std::string& path, ManifestValues& values) {
  if (node.kind != yaml::YamlNode::Kind::map || node.entries.empty()) {
    values[path] = yaml::flow_text(node);
    return;
  }
  std::vector<std::string> keys;
  for (const yaml::YamlEntry& entry : node.entries) {
    keys.push_back(entry.key);
    collect(*entry.value, path.empty() ? entry.key : path + "." + entry.key, values);
  }
  if (keys.size() > 1 && std::ranges::find(ordered_maps, path) != ordered_maps.end())
    values[path + std::string(order_of_keys)] = fmt::format("{}", fmt::join(keys, ", "));
}

/// Of the notations of a number one: 2e-5 and 0.000020 are equal. Whole numbers keep all digits.
std::string canonical_number(std::string_view text) {
  if (const auto whole = text::parse_number<std::int64_t>(text)) return fmt::to_string(*whole);
  if (const auto whole = text::parse_number<std::uint64_t>(text)) return fmt::to_string(*whole);
  if (const auto real = text::parse_number<double>(text)) return fmt::to_string(*real);
  return std::string(text);
}

/// A value with its numbers in one notation.
std::string canonical(std::string_view value) {
  if (!value.starts_with('[')) return canonical_number(value);
  std::string text;
  while (!value.empty()) {
    const std::size_t end = std::min(value.find_first_of("[]{}:, "), value.size());
    text += canonical_number(value.substr(0, end));
    if (end < value.size()) text += value[end];
    value.remove_prefix(std::min(end + 1, value.size()));
  }
  return text;
}

std::string described(const ManifestDifference& difference) {
  if (difference.baseline.empty())
    return fmt::format("{} is {} here, and not given there", difference.key, difference.current);
  if (difference.current.empty())
    return fmt::format("{} is {} there, and not given here", difference.key, difference.baseline);
  return fmt::format("{} is {} there and {} here", difference.key, difference.baseline, difference.current);
}

bool is_of_order(const ManifestDifference& difference) {
  return difference.key.ends_with(order_of_keys);
}

}  // namespace

ManifestValues values_of(const yaml::YamlNode& root) {
  ManifestValues values;
  collect(root, "", values);
  return values;
}

ManifestValues values_of(const std::string& text, const std::string& source,
                         const std::vector<std::string>& overrides) {
  yaml::Problems problems;
  std::deque<std::string> override_sources;
  yaml::YamlPointer root = yaml::parse_yaml(text, source, false, problems);
  if (root) root = apply_overrides(root, overrides, override_sources, problems);
  problems.raise_if_any();
  return root ? values_of(*root) : ManifestValues{};
}

std::string value_or(const ManifestValues& values, const std::string& key, const std::string& absent) {
  const auto found = values.find(key);
  return found == values.end() ? absent : found->second;
}

std::vector<ManifestDifference> manifest_differences(const ManifestValues& baseline,
                                                     const ManifestValues& current) {
  std::set<std::string> keys;
  for (const auto& [key, value] : baseline) keys.insert(key);
  for (const auto& [key, value] : current) keys.insert(key);
  std::vector<ManifestDifference> differences;
  for (const std::string& key : keys) {
    ManifestDifference difference{key, value_or(baseline, key, ""), value_or(current, key, "")};
    if (canonical(difference.baseline) != canonical(difference.current))
      differences.push_back(std::move(difference));
  }
  // Other keys have another order, which need not be said.
  if (!std::ranges::all_of(differences, is_of_order)) std::erase_if(differences, is_of_order);
  return differences;
}

std::string differences_text(const std::vector<ManifestDifference>& differences) {
  std::string text;
  for (std::size_t i = 0; i < std::min(differences.size(), max_differences_listed); ++i)
    text += (i > 0 ? ", " : "") + described(differences[i]);
  if (differences.size() > max_differences_listed)
    text += fmt::format(", and {} more", differences.size() - max_differences_listed);
  return text;
}

std::string identity_text(const ManifestValues& values) {
  std::string text;
  for (const auto& [key, value] : values) text += key + '\0' + canonical(value) + '\0';
  return text;
}

}  // namespace zerocount::manifest_text
