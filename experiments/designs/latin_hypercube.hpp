#pragma once

#include <cstdint>

#include "core/random/random_numbers.hpp"

namespace zerocount {

/// The stratum of trial `index` among `count` strata: a permutation of 0 … count − 1 that is a function of
/// the stream, and takes no memory. 0 ≤ index < count ≤ 2⁵³.
///
/// A generalised Feistel network on Z_a × Z_b with a·b ≥ count (Black & Rogaway, "Ciphers with arbitrary
/// finite domains", CT-RSA 2002) whose round function is Philox, walking along its cycle until it is back
/// inside 0 … count − 1.
std::uint64_t latin_stratum(std::uint64_t index, std::uint64_t count, const RandomStream& stream);

/// Trial `index` of `count` in one dimension of a Latin hypercube (McKay, Beckman & Conover 1979), in (0, 1):
/// each of the intervals [s/count, (s + 1)/count) holds exactly one trial.
double latin_uniform(std::uint64_t index, std::uint64_t count, const RandomStream& stream);

}  // namespace zerocount
