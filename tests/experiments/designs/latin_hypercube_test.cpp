#include "experiments/designs/latin_hypercube.hpp"

#include "core/hash/sha256.hpp"
#include "experiments/designs/random_key.hpp"
#include "tests/support/test.hpp"

namespace zerocount::designs {
namespace {

random::RandomStream stream_of(std::uint64_t seed) {
  return {random_key(seed, "friction.k1"), 0};
}

TEST(LatinHypercube, StrataAreAPermutationForEveryNumberOfTrials) {
  for (std::uint64_t count = 1; count <= 300; ++count) {
    std::vector<bool> seen(count, false);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t stratum = latin_stratum(i, count, stream_of(count));
      ASSERT_LT(stratum, count);
      ASSERT_FALSE(seen[stratum]) << "stratum " << stratum << " twice of " << count;
      seen[stratum] = true;
    }
  }
}

TEST(LatinHypercube, StaysInRangeAndDistinctForHugeNumbersOfTrials) {
  for (const std::uint64_t count :
       {std::uint64_t{1'000'003}, std::uint64_t{1} << 40, (std::uint64_t{1} << 53) - 1}) {
    std::set<std::uint64_t> seen;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      const std::uint64_t stratum = latin_stratum(count - 1 - i, count, stream_of(1));
      ASSERT_LT(stratum, count);
      ASSERT_TRUE(seen.insert(stratum).second);
    }
  }
}

TEST(LatinHypercube, EveryStratumHoldsOneTrial) {
  constexpr std::uint64_t count = 1000;
  std::set<int> strata;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double u = latin_uniform(i, count, stream_of(3));
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    strata.insert(static_cast<int>(u * count));
  }
  EXPECT_EQ(strata.size(), count);
}

// All 24 permutations of four strata over 24 000 seeds: χ² with 23 degrees of freedom stays below 62.7 with
// probability 1 − 1.6e-5.
TEST(LatinHypercube, AllPermutationsAreEquallyLikely) {
  constexpr int seeds = 24000;
  std::map<std::vector<std::uint64_t>, int> counts;
  for (int seed = 0; seed < seeds; ++seed) {
    std::vector<std::uint64_t> permutation;
    for (std::uint64_t i = 0; i < 4; ++i) {
      permutation.push_back(latin_stratum(i, 4, stream_of(static_cast<std::uint64_t>(seed))));
    }
    ++counts[permutation];
  }
  ASSERT_EQ(counts.size(), 24u);
  double chi_squared = 0.0;
  for (const auto& [permutation, n] : counts) chi_squared += std::pow(n - seeds / 24.0, 2) / (seeds / 24.0);
  EXPECT_LT(chi_squared, 62.7);
}

// For independent permutations r·√(N − 1) is about standard normal: |r| < 4.4/√N but once in 90 000.
TEST(LatinHypercube, ParametersAreUncorrelatedWithEachOtherAndWithTheTrialIndex) {
  constexpr std::uint64_t count = 4000;
  const random::RandomStream first{random_key(5, "friction.k1"), 0};
  const random::RandomStream second{random_key(5, "friction.k2"), 0};
  const random::RandomStream other_point{first.key, 2};
  double with_second = 0.0;
  double with_point = 0.0;
  double with_index = 0.0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double u = latin_uniform(i, count, first) - 0.5;
    with_second += 12.0 / count * u * (latin_uniform(i, count, second) - 0.5);
    with_point += 12.0 / count * u * (latin_uniform(i, count, other_point) - 0.5);
    with_index += 12.0 / count * u * (static_cast<double>(i) / count - 0.5);
  }
  const double limit = 4.4 / std::sqrt(static_cast<double>(count));
  EXPECT_LT(std::abs(with_second), limit);
  EXPECT_LT(std::abs(with_point), limit);
  EXPECT_LT(std::abs(with_index), limit);
}

// The answers published with Random123 (its file kat_vectors, philox4x32 with 10 rounds): the first two
// output words.
TEST(Random, IsPhilox4x32WithTenRounds) {
  EXPECT_EQ(random::random_bits({{0, 0}, 0}, 0, 0u), 0xe169c58d6627e8d5u);
  EXPECT_EQ(random::random_bits({{0xffffffff, 0xffffffff}, 0xffffffff}, 0xffffffffffffffff, 0xffffffffu),
            0x41c83b0e408f276du);
  EXPECT_EQ(random::random_bits({{0xa4093822, 0x299f31d0}, 0x03707344}, 0x85a308d3243f6a88, 0x13198a2eu),
            0x94fdccebd16cfe09u);
}

// FIPS 180-4's own examples.
TEST(Random, KeysComeFromSha256) {
  EXPECT_EQ(hash::sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hash::sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Random, KeyDependsOnSeedAndName) {
  EXPECT_NE(random_key(1, "friction.k1"), random_key(2, "friction.k1"));
  EXPECT_NE(random_key(1, "friction.k1"), random_key(1, "friction.k2"));
  EXPECT_EQ(random_key(1, "friction.k1"), random_key(1, "friction.k1"));
}

TEST(Random, UniformsAreStrictlyInsideTheUnitIntervalAndSymmetric) {
  EXPECT_EQ(random::open_uniform(0), 0x1p-53);
  EXPECT_EQ(random::open_uniform(~std::uint64_t{0}), 1.0 - 0x1p-53);
  for (std::uint64_t i = 0; i < 10000; ++i) {
    const std::uint64_t bits = random::random_bits({{7, 8}, 0}, i, random::Draw::trial);
    ASSERT_EQ(random::open_uniform(bits), 1.0 - random::open_uniform(~bits));
  }
}

}  // namespace
}  // namespace zerocount::designs
