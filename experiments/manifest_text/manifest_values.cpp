#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/text/text.hpp"
#include "experiments/manifest_text/manifest_text.hpp"

namespace zerocount::manifest_text {
namespace {

/// Maps of a manifest whose order of keys matters, because it numbers design points, conditions, goals or
/// tried values.
constexpr std::array<std::string_view, 5> ordered_maps{"sweep.grid", "sweep.cases", "conditions", "goals",
                                                       "tune.free"};
constexpr std::string_view between_keys = ", ";
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
    values[path + std::string(order_of_keys)] = fmt::format("{}", fmt::join(keys, between_keys));
}

/// A number in one standard notation, so that 2e-5 and 0.000020 become equal. Whole numbers keep all digits.
/// A text that is not a number is returned unchanged.
std::string canonical_number(std::string_view text) {
  if (const auto whole = text::parse_number<std::int64_t>(text)) return fmt::to_string(*whole);
  if (const auto whole = text::parse_number<std::uint64_t>(text)) return fmt::to_string(*whole);
  if (const auto real = text::parse_number<double>(text)) return fmt::to_string(*real);
  return std::string(text);
}

bool is_of_order(std::string_view key) {
  return key.ends_with(order_of_keys);
}

/// A manifest value with all its numbers in one standard notation. Names are not changed.
std::string canonical(std::string_view key, std::string_view value) {
  if (is_of_order(key)) return std::string(value);
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

std::vector<std::string_view> sorted_keys(std::string_view order) {
  std::vector<std::string_view> keys;
  for (std::size_t at = 0; at <= order.size();) {
    const std::size_t end = std::min(order.find(between_keys, at), order.size());
    keys.push_back(order.substr(at, end - at));
    at = end + between_keys.size();
  }
  std::ranges::sort(keys);
  return keys;
}

/// Whether the difference is the order of a map whose keys differ as well. Such a difference is reported by
/// its keys already.
bool follows_from_other_keys(const ManifestDifference& difference) {
  return is_of_order(difference.key) && sorted_keys(difference.baseline) != sorted_keys(difference.current);
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
    if (canonical(key, difference.baseline) != canonical(key, difference.current) &&
        !follows_from_other_keys(difference))
      differences.push_back(std::move(difference));
  }
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
  for (const auto& [key, value] : values) text += key + '\0' + canonical(key, value) + '\0';
  return text;
}

}  // namespace zerocount::manifest_text
