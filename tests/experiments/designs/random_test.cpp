#include <gtest/gtest.h>

#include "core/hash/sha256.hpp"
#include "experiments/designs/random_key.hpp"

namespace zerocount::designs {
namespace {

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
