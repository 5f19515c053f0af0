#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/random/random_numbers.hpp"

namespace zerocount::designs {

/// Direction numbers of one Sobol dimension: 64-bit binary fractions, one for each binary digit of a trial's
/// index.
using SobolDirections = std::array<std::uint64_t, 53>;

/// Number of available dimensions.
std::size_t sobol_dimension_limit();

/// The direction numbers of Boost.Random's Sobol engine for each of `dimensions` (each below
/// sobol_dimension_limit()).
std::vector<SobolDirections> sobol_directions(std::span<const std::size_t> dimensions);

/// Point `index` (< 2⁵³) of the sequence in one dimension, in Gray-code order (Antonov & Saleev 1979) and the
/// origin first, as a 64-bit binary fraction.
std::uint64_t sobol_bits(std::uint64_t index, const SobolDirections& directions);

/// As sobol_bits, with the random digital shift of this dimension from its own stream, in (0, 1). The shift
/// keeps the stratification: each of 2^m equal intervals holds one of the trials j·2^m … (j + 1)·2^m − 1.
double sobol_uniform(std::uint64_t index, const SobolDirections& directions,
                     const random::RandomStream& stream);

}  // namespace zerocount::designs
