#pragma once

#include <cstddef>
#include <string_view>

namespace zerocount::parameters {

/// The Sobol dimension of a parameter that is not a list: its position in a fixed order, from 0 on, and after
/// the dimensions of the moves from first_sobol_dimension_beyond_moves on. New parameters are appended, so
/// that the draws of the others do not change.
/// @param parameter its name, which must be in the order
std::size_t sobol_dimension(std::string_view parameter);

}  // namespace zerocount::parameters
