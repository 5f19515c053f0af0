#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/random/random_numbers.hpp"

namespace zerocount::designs {

/// The stratum (interval of equal probability, numbered from 0) that trial `index` gets in a stratified
/// design of `count` trials: a random permutation of 0 … count − 1, determined by the stream and computed
/// without a table. 0 ≤ index < count ≤ 2⁵³.
///
/// A generalised Feistel network on Z_a × Z_b with a·b ≥ count (Black & Rogaway, "Ciphers with arbitrary
/// finite domains", CT-RSA 2002) with Philox as round function, and cycle walking until the result is in 0 …
/// count − 1.
std::uint64_t latin_stratum(std::uint64_t index, std::uint64_t count, const random::RandomStream& stream);

/// The uniform number in (0, 1) of trial `index` out of `count` trials, in one dimension of a Latin hypercube
/// (McKay, Beckman & Conover 1979): each of the intervals [s/count, (s + 1)/count) holds exactly one trial.
double latin_uniform(std::uint64_t index, std::uint64_t count, const random::RandomStream& stream);

/// The random key of the quantity `name` in a study with this seed: the first 8 bytes of SHA-256 of the text
/// "<seed>:<name>" (the seed in decimal, the name the parameter's dotted path, e.g. "20020721:friction.k1"),
/// read as two little-endian 32-bit words: bytes 0–3 are key word 0, bytes 4–7 key word 1.
random::RandomKey random_key(std::uint64_t seed, std::string_view name);

/// The radial design from which Sobol' indices are estimated (Saltelli, Annoni, Azzini, Campolongo, Ratto &
/// Tarantola, "Variance based sensitivity analysis of model output", Comput. Phys. Commun. 181, 2010).
///
/// With k factors, the trials r(k + 2) … r(k + 2) + k + 1 are row r: first A, which is Monte-Carlo trial r in
/// every factor; then B, which is Monte-Carlo trial 2⁵⁵ + r in every factor; then, for j = 0 … k − 1, A with
/// factor j from B. The rows are independent, and additional rows do not change earlier ones.

/// Number of trials in one row of the radial design for Sobol' indices (Saltelli et al. 2010): k + 2 for k
/// factors. A row is a base trial A, a trial B, and for each factor the trial A with this factor taken from
/// B.
constexpr std::uint64_t saltelli_row_length(std::size_t factors) {
  return static_cast<std::uint64_t>(factors) + 2;
}

/// The Monte-Carlo trial whose random number trial `index` (at most 2⁵³) of the radial design for Sobol'
/// indices (saltelli) takes for factor `factor`, 0 ≤ factor < factors.
constexpr std::uint64_t saltelli_source(std::uint64_t index, std::size_t factor, std::size_t factors) {
  constexpr std::uint64_t second_sample = std::uint64_t{1} << 55;  // larger than every trial index of a study
  const std::uint64_t row = index / saltelli_row_length(factors);
  const std::uint64_t place = index % saltelli_row_length(factors);
  const bool from_b = place == 1 || place == factor + 2;
  return from_b ? second_sample + row : row;
}

/// Direction numbers of one Sobol dimension: 64-bit binary fractions, one for each binary digit of a trial's
/// index.
using SobolDirections = std::array<std::uint64_t, 53>;

/// The direction numbers of Boost.Random's Sobol engine for each of `dimensions`. Each is below the
/// max_dimension of Boost.Random's default table.
std::vector<SobolDirections> sobol_directions(std::span<const std::size_t> dimensions);

/// Point `index` (< 2⁵³) of Sobol's low-discrepancy sequence in one dimension, as a 64-bit binary fraction.
/// The points are in Gray-code order (Antonov & Saleev 1979); point 0 is the origin.
std::uint64_t sobol_bits(std::uint64_t index, const SobolDirections& directions);

/// The point of sobol_bits() with the random digital shift (exclusive or of its bits with a random number) of
/// this dimension, as a number in (0, 1). The shift keeps the stratification: each of 2^m equal intervals
/// holds one of the trials j·2^m … (j + 1)·2^m − 1.
double sobol_uniform(std::uint64_t index, const SobolDirections& directions,
                     const random::RandomStream& stream);

}  // namespace zerocount::designs
