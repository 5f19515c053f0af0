#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::manifest_text {

/// The node at the path of keys; null if there is none.
const yaml::YamlNode* node_at(const yaml::YamlNode& root, std::string_view path);

/// The value in place of the one before, with whose `aging` it changes with age unless it says how itself.
/// @param before null: there was none
yaml::YamlPointer aging_like(const yaml::YamlNode* before, const yaml::YamlPointer& value);

/// Applies `overrides` ("key=value", with the value as YAML) to the tree `root`, in order. Keys are dotted
/// paths, with an index for lists: trials, plant.inertia, command.targets.0, sweep.grid.controller.kp.
/// Missing maps are created; `zerocount` cannot be overridden. A value with `aging` keeps it (aging_like()).
/// `sources` gets the names under which the overrides appear in messages, and must outlive the result.
yaml::YamlPointer apply_overrides(yaml::YamlPointer root, const std::vector<std::string>& overrides,
                                  std::deque<std::string>& sources, yaml::Problems& problems);

/// Whether the text can be a dotted path: keys without empty ones among them.
bool is_dotted_path(std::string_view text);

/// A copy of the tree in which `path` has this value; missing maps are created. Null, after a report at
/// `place`, if the path leads through a value.
yaml::YamlPointer with_value(const yaml::YamlPointer& root, std::string_view path, yaml::YamlPointer value,
                             const yaml::Place& place, yaml::Problems& problems);

/// Whether the tree has a value at `path`, a path of keys without dots.
bool has_value_at(const yaml::YamlNode& root, std::string_view path);

/// Reports overrides in `root` without effect, because a grid or every case of the sweep gives the key at all
/// points.
void report_swept_overrides(const yaml::YamlNode& root, const std::vector<std::string>& overrides,
                            std::deque<std::string>& sources, yaml::Problems& problems);

/// The text of a manifest with the override "path=value" (path: dotted keys) written into it: the value at
/// the path is replaced, or the missing keys are added. All else, comments included, stays as it is.
/// @param value in flow style
/// @returns nothing where the edited text would not mean the same as the override: the path leads through a
/// list, or into a value that an alias repeats.
std::optional<std::string> with_override(const std::string& text, std::string_view path,
                                         std::string_view value);

}  // namespace zerocount::manifest_text
