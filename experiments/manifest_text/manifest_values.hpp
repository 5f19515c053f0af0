#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::manifest_text {

/// The values of a manifest by their dotted paths, as written. A list is one value, as YAML on one line.
/// Where the order of the keys of a map numbers design points, conditions, goals or the values that `tune`
/// tries, it is a value too, with a key that ends in `order_of_keys`.
using ManifestValues = std::map<std::string, std::string>;

inline constexpr std::string_view order_of_keys = ", order of keys";

/// @param root a manifest with its overrides applied
ManifestValues values_of(const yaml::YamlNode& root);
/// @param text of the manifest @param source its name in messages
/// @throws Failure (bad_input) where it is not YAML that this program accepts
ManifestValues values_of(const std::string& text, const std::string& source,
                         const std::vector<std::string>& overrides);

/// The value of a key that is a text or a number; `absent` where it is missing.
std::string value_or(const ManifestValues& values, const std::string& key, const std::string& absent);

/// A key that is in one manifest only, or has different values.
struct ManifestDifference {
  std::string key;       ///< dotted path
  std::string baseline;  ///< YAML on one line; empty where the key is missing
  std::string current;
};

/// The keys with different values, sorted. Comments, line ends, spacing, the order of other keys and the
/// notation of numbers do not matter.
std::vector<ManifestDifference> manifest_differences(const ManifestValues& baseline,
                                                     const ManifestValues& current);

/// "seed is 42 there and 43 here, …": the first five differences, and the number of others.
std::string differences_text(const std::vector<ManifestDifference>& differences);

/// A text that is equal for manifests without differences, and for them alone.
std::string identity_text(const ManifestValues& values);

}  // namespace zerocount::manifest_text
