#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runners/command_line/command_line.hpp"

/// Options whose values are numbers.
namespace zerocount {

/// A number strictly between 0 and 1, such as 0.95.
/// @throws Failure (bad_input) for anything else.
std::optional<double> probability_option(const Arguments& arguments, std::string_view option);

/// The design points that --point names, each by its label or by its number from 0; none where it is not
/// given.
/// @param labels of all points, in their order
/// @throws Failure (bad_input) for anything else.
std::vector<std::int64_t> point_options(const Arguments& arguments, std::span<const std::string> labels);

/// As point_options, of an option that cannot be repeated.
std::optional<std::int64_t> point_option(const Arguments& arguments, std::span<const std::string> labels);

}  // namespace zerocount
