#pragma once

#include <span>
#include <string>

#include "experiments/yaml/scalars.hpp"

namespace zerocount::parameters {

/// Reports as an error every key of the map that is not one of `known`; see add_unknown_key.
void check_keys(const yaml::Field& map, std::span<const std::string> known, yaml::Problems& problems);

/// Reports that `entry` of `map` has a key that is not one of `known`, and suggests the nearest known key or,
/// if none is near, the parameter with the same name in another section.
void add_unknown_key(const yaml::Field& map, const yaml::YamlEntry& entry, std::span<const std::string> known,
                     yaml::Problems& problems);

}  // namespace zerocount::parameters
