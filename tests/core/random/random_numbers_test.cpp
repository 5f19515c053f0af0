// The numbers drawn while a trial runs: one for every trial, number and stream, by Philox.
#include "core/random/random_numbers.hpp"

#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace zerocount::random {
namespace {

constexpr RandomKey key{0xa4093822, 0x299f31d0};

TEST(RandomBitsAt, PacksTrialNumberAndStreamIntoTheCounter) {
  // The documented counter words, handed over one by one.
  EXPECT_EQ(random_bits_at({key, 0}, 0, 0), random_bits({key, 0}, 0, 0u));
  EXPECT_EQ(random_bits_at({key, 7}, 5, 9), random_bits({key, 7}, 5, 9u));
  EXPECT_EQ(random_bits_at({key, 7}, 0x12'3456'789a'bcde, 0xfe'dcba'9876),
            random_bits({key, 7}, 0xfe12'3456'789a'bcde, 0xdcba'9876u));
}

TEST(RandomBitsAt, DependsOnEveryBitOfTrialNumberAndStreamAndOnNothingTwice) {
  // All coordinates with at most two bits set: were two of them packed into the same counter, two of the
  // numbers would be equal.
  struct Coordinates {
    std::uint64_t trial;
    std::uint64_t k;
    std::uint32_t stream;
  };
  std::vector<Coordinates> single{{0, 0, 0}};
  for (int bit = 0; bit < 56; ++bit) single.push_back({std::uint64_t{1} << bit, 0, 0});
  for (int bit = 0; bit < 40; ++bit) single.push_back({0, std::uint64_t{1} << bit, 0});
  for (int bit = 0; bit < 32; ++bit) single.push_back({0, 0, std::uint32_t{1} << bit});

  std::set<std::uint64_t> numbers;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < single.size(); ++i) {
    for (std::size_t j = i; j < single.size(); ++j) {
      if (i == j && i != 0) continue;  // the single bits come with i = 0
      numbers.insert(random_bits_at({key, single[i].stream | single[j].stream},
                                    single[i].trial | single[j].trial, single[i].k | single[j].k));
      ++drawn;
    }
  }
  EXPECT_EQ(numbers.size(), drawn);
}

}  // namespace
}  // namespace zerocount::random
