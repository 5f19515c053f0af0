#pragma once

#include <span>
#include <string>

#include "experiments/yaml/scalars.hpp"

namespace zerocount::parameters {

/// Reports every key of the map that is not one of `known`; see add_unknown_key.
void check_keys(const yaml::Field& map, std::span<const std::string> known, yaml::Problems& problems);

/// Reports that `entry` of `map` is not one of the keys `known`, and suggests the nearest of them or, if none
/// is near, the parameter with the same name in another section.
void add_unknown_key(const yaml::Field& map, const yaml::YamlEntry& entry, std::span<const std::string> known,
                     yaml::Problems& problems);

}  // namespace zerocount::parameters
