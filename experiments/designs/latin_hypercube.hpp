#pragma once

#include <cstdint>

#include "core/random/random_numbers.hpp"

namespace zerocount::designs {

/// The stratum of trial `index` among `count` strata: a random permutation of 0 … count − 1, determined by
/// the stream and computed without a table. 0 ≤ index < count ≤ 2⁵³.
///
/// A generalised Feistel network on Z_a × Z_b with a·b ≥ count (Black & Rogaway, "Ciphers with arbitrary
/// finite domains", CT-RSA 2002) with Philox as round function, and cycle walking until the result is in 0 …
/// count − 1.
std::uint64_t latin_stratum(std::uint64_t index, std::uint64_t count, const random::RandomStream& stream);

/// Trial `index` of `count` in one dimension of a Latin hypercube (McKay, Beckman & Conover 1979), in (0, 1):
/// each of the intervals [s/count, (s + 1)/count) holds exactly one trial.
double latin_uniform(std::uint64_t index, std::uint64_t count, const random::RandomStream& stream);

}  // namespace zerocount::designs
