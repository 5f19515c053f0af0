#pragma once

#include <span>
#include <string>

#include "experiments/yaml/scalars.hpp"

namespace zerocount {

/// Reports that `entry` of `map` is not one of the keys `known`, and suggests the nearest of them or, if none
/// is near, the parameter with the same name in another section.
void add_unknown_key(const Field& map, const YamlEntry& entry, std::span<const std::string> known,
                     Problems& problems);

}  // namespace zerocount
