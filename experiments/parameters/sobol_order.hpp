#pragma once

#include <cstddef>
#include <string_view>

namespace zerocount {

/// The Sobol dimension of a parameter that is no list: its place in the order in which the parameters came
/// into being, from 0 on, and beyond the moves' from first_sobol_dimension_beyond_moves on. The order only
/// grows at its end, so that a new parameter changes no other's draws.
/// @param parameter its name, which has to be in the order.
std::size_t sobol_dimension(std::string_view parameter);

}  // namespace zerocount
