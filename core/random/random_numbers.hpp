#pragma once

#include <array>
#include <cstdint>

namespace zerocount::random {

/// Counter-based random numbers: Philox4x32-10 (Salmon, Moraes, Dror & Shaw, "Parallel random numbers: as
/// easy as 1, 2, 3", SC11), so that every number of a study is a function of its coordinates alone.
///
/// Key. Two 32-bit words, made from the study's seed and the name of what is drawn. Counter. Four 32-bit
/// words: {index mod 2³², index div 2³², draw, stream}. The index is usually the trial's; `draw` is a number
/// of Draw below; the stream is 0 where all points share their draws, and point + 1 where they are
/// independent. Result. The first two output words, w = word 0 + 2³²·word 1.
using RandomKey = std::array<std::uint32_t, 2>;

/// Purpose of a random number: the third counter word.
enum class Draw : std::uint32_t {
  trial = 0,        ///< the value of a trial (or rig); the place inside its stratum with the Latin hypercube
  sobol_shift = 1,  ///< digital shift of a Sobol dimension, index 0
  profile_cosine = 2,  ///< cosine coefficient of a profile; the index is the harmonic + 2³²·rig
  profile_sine = 3,    ///< sine coefficient of a profile; index as for the cosine
  latin_round =
      16  ///< + r: round r of the Latin hypercube's permutation; the index is the half that is hashed
};

/// Position of a study's point in the random numbers of one parameter.
struct RandomStream {
  RandomKey key{};
  std::uint32_t stream{0};
};

/// 64 random bits w.
std::uint64_t random_bits(const RandomStream& stream, std::uint64_t index, std::uint32_t draw);
std::uint64_t random_bits(const RandomStream& stream, std::uint64_t index, Draw draw);

/// 64 random bits w of number `k`, usually that of the sample, drawn while trial number `trial` runs. No
/// other numbers have this key, so that the counter needs no Draw:
///
///   counter words {trial mod 2³², trial div 2³² + 2²⁴·(k div 2³²), k mod 2³², stream}.
///
/// @param trial less than 2⁵⁶. @param k less than 2⁴⁰. No two numbers of a key then share a counter.
std::uint64_t random_bits_at(const RandomStream& stream, std::uint64_t trial, std::uint64_t k);

/// The bits as a uniform number in the open interval (0, 1): (⌊w/2¹²⌋ + ½)·2⁻⁵². Exact, so never 0 or 1, and
/// symmetric about ½.
double open_uniform(std::uint64_t bits);

}  // namespace zerocount::random
