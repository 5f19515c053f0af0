#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace zerocount::study {

/// The design point that a user names: by its label, by its number from 0, or as tables show it, with the
/// paths in its label shortened to their ends: "kp=400 ki=8e4" or "3 (kp=400 ki=8e4)". A label takes
/// precedence over a number, because it may be one. Nothing where no point, or more than one, has this name.
/// @param labels of all points, in their order
std::optional<std::int64_t> point_named(std::string_view text, std::span<const std::string> labels);

}  // namespace zerocount::study
