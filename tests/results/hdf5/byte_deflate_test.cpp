// zlib streams of the bytes of columns, read by libdeflate.
#include "results/hdf5/byte_deflate.hpp"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <libdeflate.h>

#include "tests/support/draws.hpp"

namespace zerocount::hdf5 {
namespace {

/// The bytes of a stream of so many; empty where it has others.
std::vector<std::byte> inflated(const std::vector<std::byte>& stream, std::size_t size) {
  std::vector<std::byte> bytes(size);
  libdeflate_decompressor* const decompressor = libdeflate_alloc_decompressor();
  const auto result = libdeflate_zlib_decompress(decompressor, stream.data(), stream.size(), bytes.data(),
                                                 bytes.size(), nullptr);
  libdeflate_free_decompressor(decompressor);
  return result == LIBDEFLATE_SUCCESS ? bytes : std::vector<std::byte>{};
}

/// Calls next() for each further byte.
template <class Next>
void append(std::vector<std::byte>& bytes, std::int64_t count, const Next& next) {
  for (std::int64_t i = 0; i < count; ++i) bytes.push_back(static_cast<std::byte>(next(i)));
}

/// Bytes of one kind: runs, ramps, random ones, few different ones, uneven ones, and what stood before.
void append_some(std::vector<std::byte>& bytes, testing::Draws& draws) {
  const std::int64_t count = draws.integer(0, draws.integer(1, 9000));
  const std::int64_t number = draws.integer(1, 255);
  const auto before = static_cast<std::size_t>(draws.integer(1, draws.integer(1, 40000)));
  switch (draws.integer(0, 6)) {
    case 0:
      return append(bytes, count, [&](std::int64_t) { return number; });
    case 1:
      return append(bytes, count, [](std::int64_t i) { return i; });
    case 2:
      return append(bytes, count, [&](std::int64_t) { return draws.integer(0, 255); });
    case 3:
      return append(bytes, count, [&](std::int64_t) { return draws.integer(0, 2); });
    case 4:
      return append(bytes, count, [&](std::int64_t i) { return i / (number % 7 + 1); });
    case 5:
      return append(bytes, count,
                    [&](std::int64_t) { return 7 * static_cast<int>(-std::log2(draws.uniform(1e-9, 1.0))); });
    default:
      return append(bytes, count, [&](std::int64_t) {
        return std::to_integer<int>(bytes.size() >= before ? bytes[bytes.size() - before] : std::byte{0});
      });
  }
}

TEST(ByteDeflate, IsReadAsItsBytes) {
  testing::Draws draws(20260121);
  for (int round = 0; round < 600; ++round) {
    std::vector<std::byte> bytes;
    const std::int64_t size = draws.chance(0.3) ? draws.integer(0, 100) : draws.integer(0, 70000);
    while (std::ssize(bytes) < size) append_some(bytes, draws);
    const std::vector<std::byte> stream = zlib_stream(bytes);
    ASSERT_EQ(inflated(stream, bytes.size()), bytes) << round;
    ASSERT_LE(stream.size(), bytes.size() + 5 * (bytes.size() / 16384 + 1) + 11) << round;
  }
}

// The rarest byte would have a longer code than deflate allows: each occurs as often as the two before.
TEST(ByteDeflate, LimitsTheLengthOfCodes) {
  std::vector<std::byte> bytes;
  for (std::int64_t value = 0, count = 1, next = 1; value < 18; ++value) {
    append(bytes, count, [&](std::int64_t) { return value; });
    next += std::exchange(count, next);
  }
  // No runs, and nothing that recurs.
  testing::Draws draws(20260122);
  for (std::size_t i = bytes.size(); i > 1; --i)
    std::swap(bytes[i - 1],
              bytes[static_cast<std::size_t>(draws.integer(0, static_cast<std::int64_t>(i) - 1))]);
  const std::vector<std::byte> stream = zlib_stream(bytes);
  EXPECT_EQ(inflated(stream, bytes.size()), bytes);
  EXPECT_LT(stream.size(), bytes.size() / 2);
}

TEST(ByteDeflate, CompressesRunsAndRampsToLittle) {
  std::vector<std::byte> zeros(131072), ramp;
  append(ramp, 131072, [](std::int64_t i) { return i; });
  EXPECT_LT(zlib_stream(zeros).size(), 400U);
  EXPECT_LT(zlib_stream(ramp).size(), 3000U);
}

// Such as the samples of trials that do nearly the same.
TEST(ByteDeflate, FindsStringsThatRecurAtAnyDistance) {
  testing::Draws draws(20260123);
  std::vector<std::vector<std::byte>> strings(20);
  for (std::vector<std::byte>& string : strings)
    append(string, draws.integer(40, 200), [&](std::int64_t) { return draws.integer(0, 255); });
  std::vector<std::byte> bytes;
  while (bytes.size() < 65536) {
    const auto& string = strings[static_cast<std::size_t>(draws.integer(0, 19))];
    bytes.insert(bytes.end(), string.begin(), string.end());
  }
  const std::vector<std::byte> stream = zlib_stream(bytes);
  EXPECT_EQ(inflated(stream, bytes.size()), bytes);
  EXPECT_LT(stream.size(), bytes.size() / 4);
}

}  // namespace
}  // namespace zerocount::hdf5
