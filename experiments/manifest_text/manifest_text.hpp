#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/study/study.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::manifest_text {

/// The values of a manifest by their dotted paths, as written. A list is one value, as YAML on one line. If
/// the order of the keys of a map numbers design points, conditions, goals or the values that `tune` tries,
/// this order is a value too; its key ends in `order_of_keys`.
using ManifestValues = std::map<std::string, std::string>;

inline constexpr std::string_view order_of_keys = ", order of keys";

/// The values of a parsed manifest.
/// @param root manifest with its overrides applied
ManifestValues values_of(const yaml::YamlNode& root);
/// The values of a manifest given as text.
/// @param text text of the manifest
/// @param source name of the text in messages
/// @throws Failure (bad_input) if the text is not YAML that this program accepts
ManifestValues values_of(const std::string& text, const std::string& source,
                         const std::vector<std::string>& overrides);

/// The value of a key that is a text or a number; `absent` if the key is missing.
std::string value_or(const ManifestValues& values, const std::string& key, const std::string& absent);

/// A key whose value differs between two manifests, or that only one of them has.
struct ManifestDifference {
  std::string key;       ///< dotted path of the key
  std::string baseline;  ///< value in the baseline, YAML on one line; empty if the key is missing
  std::string current;   ///< value in the current manifest, YAML on one line; empty if the key is missing
};

/// The keys whose values differ between the manifests, sorted by key. Comments, line ends, spacing, the order
/// of other keys and the notation of numbers do not matter.
std::vector<ManifestDifference> manifest_differences(const ManifestValues& baseline,
                                                     const ManifestValues& current);

/// Text of the first five differences and the number of others: "seed is 42 there and 43 here, …".
std::string differences_text(const std::vector<ManifestDifference>& differences);

/// A text that is equal for two manifests if and only if all their keys have equal values.
std::string identity_text(const ManifestValues& values);

/// The node of the YAML tree at the dotted path of keys; null if there is none.
const yaml::YamlNode* node_at(const yaml::YamlNode& root, std::string_view path);

/// A copy of `value`, with which it can replace the value `before`: it keeps the law of aging (`aging`) of
/// the replaced value, unless it has its own.
/// @param before value to be replaced; null: there is none
yaml::YamlPointer aging_like(const yaml::YamlNode* before, const yaml::YamlPointer& value);

/// Applies `overrides` ("key=value", with the value as YAML) to the tree `root`, in order. Keys are dotted
/// paths, with an index for lists: trials, plant.inertia, command.targets.0, sweep.grid.controller.kp.
/// Missing maps are created; `zerocount` cannot be overridden. A value with `aging` keeps it (aging_like()).
/// `sources` gets the names under which the overrides appear in messages, and must outlive the result.
yaml::YamlPointer apply_overrides(yaml::YamlPointer root, const std::vector<std::string>& overrides,
                                  std::deque<std::string>& sources, yaml::Problems& problems);

/// Whether the text can be a dotted path of keys ("plant.inertia"): none of its keys is empty.
bool is_dotted_path(std::string_view text);

/// A copy of the tree in which `path` has this value; missing maps are created. Null if the path leads
/// through a value that is not a map; this is reported at `place`.
yaml::YamlPointer with_value(const yaml::YamlPointer& root, std::string_view path, yaml::YamlPointer value,
                             const yaml::Place& place, yaml::Problems& problems);

/// Whether the tree has a value at `path`, a path of keys without dots.
bool has_value_at(const yaml::YamlNode& root, std::string_view path);

/// Reports overrides (key=value) in `root` that have no effect, because the grid or every case of the sweep
/// gives the key at all design points.
void report_swept_overrides(const yaml::YamlNode& root, const std::vector<std::string>& overrides,
                            std::deque<std::string>& sources, yaml::Problems& problems);

/// The text of a manifest with the override "path=value" (path: dotted keys) written into it: the value at
/// the path is replaced, or the missing keys are added. All else, comments included, stays as it is.
/// @param value in flow style
/// @returns empty if the edited text would not mean the same as the override, because the path leads through
/// a list or into a value that an alias repeats
std::optional<std::string> with_override(const std::string& text, std::string_view path,
                                         std::string_view value);

/// Changes that turn the manifest of a study into a manifest of one of its design points.
struct PointChanges {
  /// Name of the condition whose overrides are written into the sections in place of `conditions`; empty:
  /// none.
  std::string condition{};
  /// Parameters whose values in the manifest are replaced: pairs (dotted path, number).
  std::vector<std::pair<std::string, double>> values{};
  /// Keys at the root of the manifest whose values are replaced: pairs (key, YAML text).
  std::vector<std::pair<std::string, std::string>> keys{};
  std::vector<std::string> removed{};  ///< keys to be left out: keys at the root, or "section.key"
  /// Folder to which the file names in the study's manifest are relative; empty: its files are not known.
  std::filesystem::path folder{};
};

/// A manifest of one design point of a study, in flow style. It includes the overrides of the study, but not
/// the sweep and the keys that refer to the sweep. Comments are lost.
/// @throws Failure (bad_input) if a value has no place in the manifest, or if the manifest names a file that
/// is not known
std::string manifest_of_point(const study::Study& study, std::int64_t point, const PointChanges& changes);

/// The override "conditions={…}" that keeps only one of the study's conditions.
std::string only_condition(const study::Study& study, const std::string& condition);

}  // namespace zerocount::manifest_text
