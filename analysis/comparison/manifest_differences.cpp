#include "analysis/comparison/manifest_differences.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "core/text/number_text.hpp"
#include "experiments/manifest/manifest_keys.hpp"
#include "experiments/manifest/overrides.hpp"
#include "experiments/parameters/earlier_defaults.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::comparison {
namespace {

void collect(const yaml::YamlNode& node, const std::string& path, ManifestValues& values) {
  if (node.kind != yaml::YamlNode::Kind::map || node.entries.empty()) {
    values[path] = yaml::flow_text(node);
    return;
  }
  for (const yaml::YamlEntry& entry : node.entries) {
    collect(*entry.value, path.empty() ? entry.key : path + "." + entry.key, values);
  }
}

/// Whether the manifest gives the parameter a value, or one to every point of a grid.
bool gives(const ManifestValues& values, std::string_view parameter) {
  return std::any_of(values.begin(), values.end(), [&](const auto& entry) {
    return manifest::is_within(entry.first, parameter) ||
           manifest::is_within(entry.first, fmt::format("sweep.grid.{}", parameter));
  });
}

void write_default(ManifestValues& values, const parameters::Parameter& parameter, std::int64_t version) {
  if (gives(values, parameter.name)) return;
  values[std::string(parameter.name)] =
      parameters::number_text(parameter, parameters::default_value_in(parameter, version));
}

bool same_value(const std::string& one, const std::string& other) {
  const std::optional<double> number = text::parse_number<double>(one);
  return one == other || (number && number == text::parse_number<double>(other));
}

}  // namespace

ManifestValues manifest_values(const layout::FileHeader& header, const std::string& source) {
  const std::string place = source + ":/manifest";
  yaml::Problems problems;
  std::deque<std::string> override_sources;
  yaml::YamlPointer root = yaml::parse_yaml(header.manifest, place, false, problems);
  if (root) root = manifest::apply_overrides(root, header.overrides, override_sources, problems);
  try {
    problems.raise_if_any();
  } catch (const Failure& failure) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: its manifest cannot be read: {}", source, failure.what()));
  }
  ManifestValues values;
  if (root) collect(*root, "", values);
  if (header.samples) values["samples, SHA-256 of the table"] = hash::sha256_hex(*header.samples);
  return values;
}

void write_changed_defaults(ManifestValues& baseline, std::int64_t baseline_version, ManifestValues& current,
                            std::int64_t current_version) {
  for (const parameters::EarlierDefault& earlier : parameters::earlier_defaults()) {
    const parameters::Parameter& parameter =
        parameters::parameter_table()[parameters::find_parameter(earlier.name).value()];
    if (parameters::default_value_in(parameter, baseline_version) ==
        parameters::default_value_in(parameter, current_version))
      continue;
    write_default(baseline, parameter, baseline_version);
    write_default(current, parameter, current_version);
  }
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
    if (!same_value(difference.baseline, difference.current)) differences.push_back(std::move(difference));
  }
  return differences;
}

}  // namespace zerocount::comparison
