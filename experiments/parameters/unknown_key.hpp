#pragma once

#include <span>
#include <string>

#include "experiments/yaml/scalars.hpp"

namespace zerocount {

/// Reports that `entry` of `map` is none of the keys `known` there, and names the nearest: one of them, or,
/// where none of them is near, the parameter that has this very name in another section.
void add_unknown_key(const Field& map, const YamlEntry& entry, std::span<const std::string> known,
                     Problems& problems);

}  // namespace zerocount
