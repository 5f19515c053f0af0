#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace zerocount {

/// Counter-based random numbers: Philox4x32-10 (Salmon, Moraes, Dror & Shaw, "Parallel random numbers: as
/// easy as 1, 2, 3", SC11), so that every number of a study is a function of its own coordinates and of
/// nothing else.
///
/// Key. The first 8 bytes of SHA-256 of the text "<seed>:<name>" (the seed in decimal, the name the
/// parameter's dotted path, e.g. "20020721:friction.k1"), read as two little-endian 32-bit words: bytes 0–3
/// are key word 0, bytes 4–7 key word 1. Counter. Four 32-bit words: {index mod 2³², index div 2³², draw,
/// stream}. The index is the trial's; `draw` is a number of Draw below; the stream is 0 where all points
/// share their draws, and point + 1 where they are independent. Result. The first two output words, w = word
/// 0 + 2³²·word 1.
using RandomKey = std::array<std::uint32_t, 2>;

/// What a number is drawn for: the third counter word.
enum class Draw : std::uint32_t {
  trial = 0,           ///< a trial's value; the place inside its stratum with the Latin hypercube
  sobol_shift = 1,     ///< digital shift of a Sobol dimension, index 0
  profile_cosine = 2,  ///< cosine coefficient of a profile; the index is the harmonic
  profile_sine = 3,    ///< sine coefficient of a profile; the index is the harmonic
  latin_round =
      16  ///< + r: round r of the Latin hypercube's permutation; the index is the half that is hashed
};

/// Where in the random numbers of one parameter a study's point draws.
struct RandomStream {
  RandomKey key{};
  std::uint32_t stream{0};
};

RandomKey random_key(std::uint64_t seed, std::string_view name);

/// 64 random bits w.
std::uint64_t random_bits(const RandomStream& stream, std::uint64_t index, std::uint32_t draw);
std::uint64_t random_bits(const RandomStream& stream, std::uint64_t index, Draw draw);

/// The bits as a uniform number in the open interval (0, 1): (⌊w/2¹²⌋ + ½)·2⁻⁵². Exact, so never 0 or 1, and
/// symmetric about ½.
double open_uniform(std::uint64_t bits);

}  // namespace zerocount
