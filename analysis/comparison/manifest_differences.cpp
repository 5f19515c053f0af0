#include "analysis/comparison/manifest_differences.hpp"

#include <deque>
#include <set>

#include <fmt/format.h>

#include "core/failure.hpp"
#include "experiments/language/overrides.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount {
namespace {

void collect(const YamlNode& node, const std::string& path, ManifestValues& values) {
  if (node.kind != YamlNode::Kind::map || node.entries.empty()) {
    values[path] = flow_text(node);
    return;
  }
  for (const YamlEntry& entry : node.entries) {
    collect(*entry.value, path.empty() ? entry.key : path + "." + entry.key, values);
  }
}

}  // namespace

ManifestValues manifest_values(const FileHeader& header, const std::string& source) {
  const std::string place = source + ":/manifest";
  Problems problems;
  std::deque<std::string> override_sources;
  YamlPointer root = parse_yaml(header.manifest, place, false, problems);
  if (root) root = apply_overrides(root, header.overrides, override_sources, problems);
  try {
    problems.raise_if_any();
  } catch (const Failure& failure) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: its manifest cannot be read: {}", source, failure.what()));
  }
  ManifestValues values;
  if (root) collect(*root, "", values);
  return values;
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
    if (difference.baseline != difference.current) differences.push_back(std::move(difference));
  }
  return differences;
}

}  // namespace zerocount
