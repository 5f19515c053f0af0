#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "runners/command_line.hpp"

/// Options whose values are numbers.
namespace zerocount {

/// A number strictly between 0 and 1, such as 0.95.
/// @throws Failure (bad_input) for anything else.
std::optional<double> probability_option(const Arguments& arguments, std::string_view option);

/// All values of an option that may be repeated: whole numbers, 0 or more.
/// @throws Failure (bad_input) for anything else.
std::vector<std::int64_t> whole_number_options(const Arguments& arguments, std::string_view option);

}  // namespace zerocount
