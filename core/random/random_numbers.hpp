#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace zerocount::random {

/// Counter-based random numbers: Philox4x32-10 (Salmon, Moraes, Dror & Shaw, "Parallel random numbers: as
/// easy as 1, 2, 3", SC11), so that every number of a study is a function of its coordinates alone.
///
/// Key. Two 32-bit words, made from the study's seed and the name of what is drawn. Counter. Four 32-bit
/// words: {index mod 2³², index div 2³², draw, stream}. The index is usually the trial's; `draw` is a number
/// of Draw below; the stream is 0 where all points share their draws, and point + 1 where they are
/// independent. Result. The first two output words, w = word 0 + 2³²·word 1.
using RandomKey = std::array<std::uint32_t, 2>;

/// Purpose for which a random number is drawn: the third word of the generator's counter.
enum class Draw : std::uint32_t {
  trial = 0,        ///< Value of a parameter for a trial or machine; with the Latin hypercube, the position
                    /// < inside its stratum
  sobol_shift = 1,  ///< Random digital shift that randomises a dimension of a Sobol sequence; the index is 0
  profile_cosine = 2,  ///< Cosine coefficient of a profile; the index is the harmonic + 2³²·machine
  profile_sine = 3,    ///< Sine coefficient of a profile; the index is the harmonic + 2³²·machine
  latin_round =
      16  ///< + r: round r of the Latin hypercube's permutation; the index is the half that is hashed
};

/// Selects the random numbers of one parameter at one design point: key, and stream word of the counter.
struct RandomStream {
  RandomKey key{};
  std::uint32_t stream{0};
};

/// 64 random bits for a key, stream, index and draw (see RandomKey).
/// @param index usually the index of the trial.
/// @param draw a value of Draw.
std::uint64_t random_bits(const RandomStream& stream, std::uint64_t index, std::uint32_t draw);
std::uint64_t random_bits(const RandomStream& stream, std::uint64_t index, Draw draw);

/// 64 random bits w with number `k`, usually the number of the sample, drawn while trial number `trial` runs.
/// No other numbers have this key, so that the counter needs no Draw:
///
///   counter words {trial mod 2³², trial div 2³² + 2²⁴·(k div 2³²), k mod 2³², stream}.
///
/// @param trial less than 2⁵⁶.
/// @param k less than 2⁴⁰. No two numbers of a key then share a counter.
std::uint64_t random_bits_at(const RandomStream& stream, std::uint64_t trial, std::uint64_t k);

/// The bits as a uniform number in the open interval (0, 1): (⌊w/2¹²⌋ + ½)·2⁻⁵². Exact, so never 0 or 1, and
/// symmetric about ½.
double open_uniform(std::uint64_t bits);

/// A standard normal number: Φ⁻¹(u) with u = open_uniform(bits). Its absolute value is below 8.21;
/// complementary bits give exactly the negative.
double standard_normal(std::uint64_t bits);

/// A standard normal number from random bits, for the noise in a running trial, by a formula that the
/// vectorised batch engine evaluates as well. It is within a relative 1e-15 of standard_normal(), which draws
/// the parameters of manifests (study input files).
double standard_normal_noise(std::uint64_t bits);

/// A binomial number: how many of `n` independent events of probability `probability` occur. By inversion:
/// the smallest j with F(j) ≥ u, u = open_uniform(bits), F(j) = Σ_{i≤j} C(n, i)·pⁱ·(1 − p)ⁿ⁻ⁱ.
/// @param n not negative.
/// @param probability p, in [0, 1].
std::int64_t binomial_number(std::int64_t n, double probability, std::uint64_t bits);

/// Source of successive random numbers from one stream, for searches that need no counter of their own.
class NumberSource {
 public:
  explicit NumberSource(const RandomKey& key, std::uint32_t stream = 0) : stream_{key, stream} {}

  /// The next uniform random number in (0, 1).
  double uniform() { return open_uniform(next()); }
  double normal() { return standard_normal(next()); }
  std::vector<double> normals(std::size_t count) {
    std::vector<double> numbers(count);
    for (double& number : numbers) number = normal();
    return numbers;
  }

 private:
  std::uint64_t next() { return random_bits(stream_, drawn_++, Draw::trial); }

  RandomStream stream_;
  std::uint64_t drawn_{0};
};

/// The random number streams from which numbers are drawn while a trial runs (noise, lateness and others).
/// The trial index and the stream are the counter words of the same name (RandomStream).
struct TrialRandomness {
  std::uint64_t trial{0};
  std::uint32_t stream{0};
  RandomKey history{};
  RandomKey fine_noise{};
  RandomKey fine_missed{};
  RandomKey coarse_noise{};
  RandomKey coarse_missed{};
  RandomKey dac_noise{};
  RandomKey missed_samples{};
  RandomKey jitter{};
  RandomKey spectrum{};
  RandomKey other_noise{};
  RandomKey other_missed{};
};

}  // namespace zerocount::random
