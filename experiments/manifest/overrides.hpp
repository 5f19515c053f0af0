#pragma once

#include <deque>
#include <string>
#include <vector>

#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::manifest {

/// Applies `overrides` ("key=value", with the value as YAML) to the tree `root`, in order. Keys are dotted
/// paths, with an index for lists: trials, plant.inertia, command.targets.0, sweep.grid.controller.kp.
/// Missing maps are created; `zerocount` cannot be overridden. `sources` gets the names under which the
/// overrides appear in messages, and must outlive the result.
yaml::YamlPointer apply_overrides(yaml::YamlPointer root, const std::vector<std::string>& overrides,
                                  std::deque<std::string>& sources, yaml::Problems& problems);

/// Reports overrides in `root` without effect, because a grid or every case of the sweep gives the key at all
/// points.
void report_swept_overrides(const yaml::YamlNode& root, const std::vector<std::string>& overrides,
                            std::deque<std::string>& sources, yaml::Problems& problems);

}  // namespace zerocount::manifest
