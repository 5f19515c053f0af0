#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace zerocount::study {

/// The index of the design point that a user names: by its index from 0, by its label, or as tables show it,
/// with the paths in its label shortened to their ends: "kp=400 ki=8e4" or "3 (kp=400 ki=8e4)". A whole
/// number is always an index. Empty if no point, or more than one, has this name.
/// @param labels labels of all points, in their order
std::optional<std::int64_t> point_named(std::string_view text, std::span<const std::string> labels);

}  // namespace zerocount::study
