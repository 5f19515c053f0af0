#include "results/hdf5/chunk_filters.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <string_view>

#include <libdeflate.h>

namespace zerocount::hdf5 {
namespace {

constexpr std::size_t checksum_size = 4;

/// The Fletcher-32 checksum of bytes as big-endian 16-bit words; a last single byte counts as the high byte
/// of a word.
std::uint32_t fletcher32(std::span<const std::byte> bytes) {
  constexpr std::size_t words_without_overflow = 360;
  const auto fold = [](std::uint32_t sum) { return (sum & 0xffffU) + (sum >> 16U); };
  std::uint32_t sum1 = 0;
  std::uint32_t sum2 = 0;
  const auto add = [&](std::byte high, std::byte low) {
    sum1 += std::to_integer<std::uint32_t>(high) << 8U | std::to_integer<std::uint32_t>(low);
    sum2 += sum1;
  };
  while (bytes.size() > 1) {
    const std::size_t size = std::min(bytes.size() / 2, words_without_overflow) * 2;
    for (std::size_t i = 0; i < size; i += 2) add(bytes[i], bytes[i + 1]);
    sum1 = fold(sum1);
    sum2 = fold(sum2);
    bytes = bytes.subspan(size);
  }
  if (!bytes.empty()) {
    add(bytes[0], std::byte{0});
    sum1 = fold(sum1);
    sum2 = fold(sum2);
  }
  return fold(sum2) << 16U | fold(sum1);
}

/// Eight matrices of 8 × 8 bytes, [row][matrix]; byte i of a row is its bits 8·i to 8·i + 7.
using Matrices = std::array<std::array<std::uint64_t, 8>, 8>;
constexpr std::size_t elements_of_matrices = 64;

/// Whether elements of this size can be shuffled by transposing matrices of 8 × 8 bytes: eight bytes, on a
/// little-endian processor.
constexpr bool fit_in_matrices(std::size_t element_size) {
  return element_size == 8 && std::endian::native == std::endian::little;
}

/// One step of a matrix transpose: exchanges neighbouring off-diagonal blocks of `size` × `size` bytes.
/// @param low mask that selects every other group of `size` bytes
template <std::size_t size>
void exchange_blocks(Matrices& rows, std::uint64_t low) {
  for (std::size_t row = 0; row < rows.size(); row += row % size == size - 1 ? size + 1 : 1) {
    for (std::size_t i = 0; i < 8; ++i) {  // in vectors
      const std::uint64_t exchanged = (rows[row][i] >> (8 * size) ^ rows[row + size][i]) & low;
      rows[row][i] ^= exchanged << (8 * size);
      rows[row + size][i] ^= exchanged;
    }
  }
}

/// Transposes each of the eight matrices: byte i of row j becomes byte j of row i.
void transpose(Matrices& rows) {
  exchange_blocks<1>(rows, 0x00ff00ff00ff00ff);
  exchange_blocks<2>(rows, 0x0000ffff0000ffff);
  exchange_blocks<4>(rows, 0x00000000ffffffff);
}

/// Shuffles elements of eight bytes: byte b of element i moves to position b·count + i. Only the largest
/// multiple of 64 elements is processed.
/// @returns the number of elements processed
std::size_t shuffle_eight(std::span<const std::byte> elements, std::size_t count, std::byte* to) {
  Matrices rows{};
  std::size_t first = 0;
  for (; first + elements_of_matrices <= count; first += elements_of_matrices) {
    for (std::size_t i = 0; i < elements_of_matrices; ++i)
      std::memcpy(&rows[i % 8][i / 8], elements.data() + 8 * (first + i), 8);
    transpose(rows);
    for (std::size_t byte = 0; byte < 8; ++byte)
      std::memcpy(to + byte * count + first, &rows[byte], elements_of_matrices);
  }
  return first;
}
std::size_t unshuffle_eight(std::span<const std::byte> shuffled, std::size_t count, std::byte* to) {
  Matrices rows{};
  std::size_t first = 0;
  for (; first + elements_of_matrices <= count; first += elements_of_matrices) {
    for (std::size_t byte = 0; byte < 8; ++byte)
      std::memcpy(&rows[byte], shuffled.data() + byte * count + first, elements_of_matrices);
    transpose(rows);
    for (std::size_t i = 0; i < elements_of_matrices; ++i)
      std::memcpy(to + 8 * (first + i), &rows[i % 8][i / 8], 8);
  }
  return first;
}

std::vector<std::byte> shuffle(std::size_t element_size, std::span<const std::byte> elements) {
  const std::size_t count = elements.size() / element_size;
  std::vector<std::byte> shuffled(elements.size());
  const std::size_t first =
      fit_in_matrices(element_size) ? shuffle_eight(elements, count, shuffled.data()) : 0;
  for (std::size_t byte = 0; byte < element_size; ++byte) {
    std::byte* const to = shuffled.data() + byte * count;
    for (std::size_t i = first; i < count; ++i) to[i] = elements[i * element_size + byte];
  }
  return shuffled;
}

void unshuffle(std::size_t element_size, std::span<const std::byte> shuffled, std::span<std::byte> elements) {
  const std::size_t count = elements.size() / element_size;
  const std::size_t first =
      fit_in_matrices(element_size) ? unshuffle_eight(shuffled, count, elements.data()) : 0;
  for (std::size_t byte = 0; byte < element_size; ++byte) {
    const std::byte* const from = shuffled.data() + byte * count;
    for (std::size_t i = first; i < count; ++i) elements[i * element_size + byte] = from[i];
  }
}

constexpr std::size_t page = 4096;

/// Whether the first page of `bytes` looks random, so that deflate could hardly compress it. Its byte
/// frequencies are neither more even than random ones nor so uneven that a code of them would save a
/// twentieth: their χ² is 255 ± 23 for random bytes, and up to 1300 for the last digits of a rounded product
/// or exponential. Neighbours are seldom equal, and its start does not recur within the distance at which
/// deflate finds repetitions. (Each design point repeats the draws of the one before.)
bool starts_randomly(std::span<const std::byte> bytes) {
  std::array<std::uint32_t, 256> counts{};
  std::size_t equal_neighbours = 0;  // 16 ± 4 of random bytes
  for (std::size_t i = 0; i < page; ++i) {
    ++counts[std::to_integer<std::size_t>(bytes[i])];
    equal_neighbours += i > 0 && bytes[i] == bytes[i - 1];
  }
  constexpr double expected = static_cast<double>(page) / 256.0;
  double chi_square = 0.0;
  for (const std::uint32_t count : counts) chi_square += (count - expected) * (count - expected) / expected;
  if (chi_square < 110.0 || chi_square > 1700.0 || equal_neighbours > page / 64) return false;
  constexpr std::size_t window = 32768;
  constexpr std::size_t sample = 8;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), window));
  return text.find(text.substr(0, sample), 1) == std::string_view::npos;
}

/// Number of bytes at the front, in whole pages, that look random. After the shuffle filter, these pages hold
/// the low digits of doubles.
std::size_t random_front(std::span<const std::byte> bytes) {
  std::size_t length = 0;
  while (length + page <= bytes.size() && starts_randomly(bytes.subspan(length))) length += page;
  return length;
}

/// Appends `bytes` uncompressed, as a "stored" block of the deflate format that is not the last, to a stream
/// that ends at a whole byte (RFC 1951, section 3.2.4).
void append_stored_block(std::vector<std::byte>& stream, std::span<const std::byte> bytes) {
  const auto size = static_cast<unsigned>(bytes.size());
  for (const unsigned byte : {0U, size & 0xffU, size >> 8U, ~size & 0xffU, ~size >> 8U & 0xffU})
    stream.push_back(static_cast<std::byte>(byte));
  stream.insert(stream.end(), bytes.begin(), bytes.end());
}

/// Compresses bytes to a zlib stream (RFC 1950), as the deflate filter of HDF5 reads it. Random bytes at the
/// front are stored uncompressed: compressing them would take most of the time and save nothing.
std::vector<std::byte> deflate(std::span<const std::byte> bytes, int level) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(level), libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  constexpr std::size_t max_block = 15 * page;                      // of at most 65 535 bytes
  std::vector<std::byte> stream{std::byte{0x78}, std::byte{0x01}};  // window of 32 kB, fastest
  const std::size_t stored = random_front(bytes);
  const std::span<const std::byte> rest = bytes.subspan(stored);
  const std::size_t bound = libdeflate_deflate_compress_bound(compressor.get(), rest.size());
  stream.reserve(stored + stored / page + bound + 16);
  for (std::size_t at = 0; at < stored; at += max_block)
    append_stored_block(stream, bytes.subspan(at, std::min(max_block, stored - at)));
  const std::size_t start = stream.size();
  stream.resize(start + bound);
  stream.resize(start + libdeflate_deflate_compress(compressor.get(), rest.data(), rest.size(),
                                                    stream.data() + start, bound));
  const std::uint32_t checksum = libdeflate_adler32(1, bytes.data(), bytes.size());
  for (const unsigned shift : {24U, 16U, 8U, 0U})
    stream.push_back(static_cast<std::byte>(checksum >> shift & 0xffU));
  return stream;
}

bool inflate(std::span<const std::byte> stream, std::span<std::byte> bytes) {
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!decompressor) throw std::bad_alloc();
  // Without a place for the size, a stream of another size is an error.
  return libdeflate_zlib_decompress(decompressor.get(), stream.data(), stream.size(), bytes.data(),
                                    bytes.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

/// Undoes the filters of a chunk except its checksum.
/// @returns false if the bytes do not decode to elements.size() bytes.
bool decode(const ChunkFilters& filters, std::span<const std::byte> bytes, std::span<std::byte> elements) {
  if (filters.deflate_level) {
    std::vector<std::byte> shuffled(elements.size());
    if (!inflate(bytes, shuffled)) return false;
    unshuffle(filters.element_size, shuffled, elements);
    return true;
  }
  if (bytes.size() != elements.size()) return false;
  std::ranges::copy(bytes, elements.begin());
  return true;
}

}  // namespace

std::vector<std::byte> encode_chunk(const ChunkFilters& filters, std::span<const std::byte> elements) {
  std::vector<std::byte> stored;
  if (filters.deflate_level) {
    stored = deflate(shuffle(filters.element_size, elements), *filters.deflate_level);
  } else {
    stored.assign(elements.begin(), elements.end());
  }
  const std::uint32_t checksum = fletcher32(stored);
  for (const unsigned shift : {0U, 8U, 16U, 24U})
    stored.push_back(static_cast<std::byte>(checksum >> shift & 0xffU));
  return stored;
}

bool has_valid_checksum(std::span<const std::byte> stored) {
  if (stored.size() < checksum_size) return false;
  std::uint32_t checksum = 0;
  for (const std::byte byte : {stored.end()[-1], stored.end()[-2], stored.end()[-3], stored.end()[-4]})
    checksum = checksum << 8U | std::to_integer<std::uint32_t>(byte);
  return checksum == fletcher32(stored.first(stored.size() - checksum_size));
}

bool decode_chunk(const ChunkFilters& filters, std::span<const std::byte> stored,
                  std::span<std::byte> elements) {
  return has_valid_checksum(stored) && decode(filters, stored.first(stored.size() - checksum_size), elements);
}

}  // namespace zerocount::hdf5
