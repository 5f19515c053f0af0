#include "results/hdf5/chunk_filters.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>

#include <zlib.h>

namespace zerocount::hdf5 {
namespace {

constexpr std::size_t checksum_size = 4;

/// Fletcher-32 of big-endian 16-bit words; a last single byte is the high byte of a word.
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

std::vector<std::byte> shuffle(std::size_t element_size, std::span<const std::byte> elements) {
  const std::size_t count = elements.size() / element_size;
  std::vector<std::byte> shuffled(elements.size());
  for (std::size_t byte = 0; byte < element_size; ++byte) {
    std::byte* const to = shuffled.data() + byte * count;
    for (std::size_t i = 0; i < count; ++i) to[i] = elements[i * element_size + byte];
  }
  return shuffled;
}

void unshuffle(std::size_t element_size, std::span<const std::byte> shuffled, std::span<std::byte> elements) {
  const std::size_t count = elements.size() / element_size;
  for (std::size_t byte = 0; byte < element_size; ++byte) {
    const std::byte* const from = shuffled.data() + byte * count;
    for (std::size_t i = 0; i < count; ++i) elements[i * element_size + byte] = from[i];
  }
}

/// Whether the frequencies of the byte values are those of independent random bytes, as in the low bytes of
/// random numbers. No coder can shorten these.
///
/// Pearson's χ² of the frequencies of the 256 values: 255 ± 23 for random bytes. Bytes that repeat or are not
/// uniform give more. Bytes that count up give less.
bool is_noise(std::span<const std::byte> bytes) {
  constexpr std::size_t min_size = 4096;  // 16 of each value on average
  if (bytes.size() < min_size) return false;
  std::array<std::uint32_t, 256> counts{};
  for (const std::byte byte : bytes) ++counts[std::to_integer<std::size_t>(byte)];
  const auto size = static_cast<double>(bytes.size());
  double sum = 0.0;
  for (const std::uint32_t count : counts) sum += static_cast<double>(count) * count;
  const double chi_squared = 256.0 / size * sum - size;
  return chi_squared > 128.0 && chi_squared < 400.0;
}

/// One zlib stream of parts of `part` bytes each. Noise is stored as it is, which is faster to write and to
/// read.
std::vector<std::byte> deflate(std::span<std::byte> bytes, std::size_t part, int level) {
  constexpr std::size_t bytes_of_change = 64;  // of the blocks that begin where the level changes
  const std::size_t parts = bytes.size() / std::max<std::size_t>(part, 1);
  std::vector<std::byte> result(compressBound(static_cast<uLong>(bytes.size())) + parts * bytes_of_change);
  z_stream stream{};
  if (deflateInit(&stream, level) != Z_OK) throw std::bad_alloc();
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  int status = Z_OK;
  for (; !bytes.empty(); bytes = bytes.subspan(part)) {
    const std::span<std::byte> next = bytes.first(part);
    if (status == Z_OK)
      status = deflateParams(&stream, is_noise(next) ? Z_NO_COMPRESSION : level, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(next.data());
    stream.avail_in = static_cast<uInt>(next.size());
    if (status == Z_OK) status = ::deflate(&stream, Z_NO_FLUSH);
  }
  if (status == Z_OK) status = ::deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) result.clear();  // does not decode: encode_chunk reports it
  return result;
}

bool inflate(std::span<const std::byte> stream, std::span<std::byte> bytes) {
  auto size = static_cast<uLongf>(bytes.size());
  return uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                    reinterpret_cast<const Bytef*>(stream.data()),
                    static_cast<uLong>(stream.size())) == Z_OK &&
         size == bytes.size();
}

}  // namespace

std::optional<std::vector<std::byte>> encode_chunk(const ChunkFilters& filters,
                                                   std::span<const std::byte> elements) {
  std::vector<std::byte> stored;
  if (filters.deflate_level) {
    stored = shuffle(filters.element_size, elements);
    stored = deflate(stored, stored.size() / filters.element_size, *filters.deflate_level);
  } else {
    stored.assign(elements.begin(), elements.end());
  }
  const std::uint32_t checksum = fletcher32(stored);
  for (const unsigned shift : {0U, 8U, 16U, 24U})
    stored.push_back(static_cast<std::byte>(checksum >> shift & 0xffU));
  std::vector<std::byte> decoded(elements.size());
  if (!decode_chunk(filters, stored, decoded) ||
      !std::equal(decoded.begin(), decoded.end(), elements.begin()))
    return std::nullopt;
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
  if (!has_valid_checksum(stored)) return false;
  const std::span<const std::byte> bytes = stored.first(stored.size() - checksum_size);
  if (filters.deflate_level) {
    std::vector<std::byte> shuffled(elements.size());
    if (!inflate(bytes, shuffled)) return false;
    unshuffle(filters.element_size, shuffled, elements);
    return true;
  }
  if (bytes.size() != elements.size()) return false;
  std::copy(bytes.begin(), bytes.end(), elements.begin());
  return true;
}

}  // namespace zerocount::hdf5
