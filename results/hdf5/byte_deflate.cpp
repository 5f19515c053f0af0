#include "results/hdf5/byte_deflate.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <utility>

#include <libdeflate.h>

// Deflate: RFC 1951; the numbers of sections are its own.
namespace zerocount::hdf5 {
namespace {

constexpr std::size_t block_size = 16384;
constexpr std::size_t end_of_block = 256;  ///< symbol
constexpr std::size_t literals_and_lengths = 286;
constexpr std::size_t distances = 16;  ///< of which code 0 is a distance of 1, and code 15 with six bits 256
constexpr std::size_t code_length_symbols = 19;
constexpr int max_bits = 15, max_bits_of_code_lengths = 7;

/// Bits of a number, the first one lowest.
struct Bits {
  std::uint32_t value{0};
  std::uint32_t count{0};
};

/// Bytes that stand for themselves, and then a repetition of what stands `distance` bytes before.
struct Segment {
  std::span<const std::byte> literals;
  std::size_t repeated{0};  ///< 0, or at least 8
  std::size_t distance{1};
};

std::uint64_t eight_bytes(const std::byte* from) {
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, from, sizeof bytes);
  return bytes;
}

/// Divides the bytes from `begin` to `end` into segments. @param first of the whole stream
std::vector<Segment> segments_of(const std::byte* first, const std::byte* begin, const std::byte* end) {
  constexpr std::size_t step = 8;
  std::vector<Segment> segments;
  const std::byte* literals = begin;
  const auto repeats = [&](const std::byte* at, std::ptrdiff_t distance) {
    return end - at >= static_cast<std::ptrdiff_t>(step) && at - first >= distance &&
           eight_bytes(at) == eight_bytes(at - distance);
  };
  for (const std::byte* at = begin; at < end;) {
    const std::ptrdiff_t distance = repeats(at, 1) ? 1 : 256;
    const std::byte* after = at;
    while (repeats(after, distance)) after += step;
    if (after == at) {
      at += std::min<std::ptrdiff_t>(step, end - at);
      continue;
    }
    segments.push_back({{literals, at}, static_cast<std::size_t>(after - at), static_cast<std::size_t>(distance)});
    literals = at = after;
  }
  segments.push_back({{literals, end}, 0, 1});
  return segments;
}

/// A repetition as lengths of 3 to 258 bytes. Calls visit(length).
template <class Visit>
void for_each_length(std::size_t repeated, const Visit& visit) {
  while (repeated > 0) {
    std::size_t length = repeated;
    if (repeated > 258) length = repeated < 266 ? 250 : 258;  // what remains is not too short
    visit(length);
    repeated -= length;
  }
}

/// Symbol of a length, and its extra bits (section 3.2.5).
std::pair<std::size_t, Bits> symbol_of_length(std::size_t length) {
  if (length == 258) return {285, {}};
  const auto above_shortest = static_cast<std::uint32_t>(length - 3);
  if (above_shortest < 8) return {257 + above_shortest, {}};
  const std::uint32_t extra = static_cast<std::uint32_t>(std::bit_width(above_shortest)) - 3;
  return {261 + 4 * extra + (above_shortest >> extra & 3U), {above_shortest & ((1U << extra) - 1), extra}};
}

/// Lengths of a Huffman code for symbols that occur so often, at most `limit` bits; 0 of those that do not
/// occur. @param counts at least two are above 0
template <std::size_t symbols>
std::array<std::uint8_t, symbols> code_lengths(const std::array<std::uint32_t, symbols>& counts, int limit) {
  std::vector<std::pair<std::uint32_t, std::size_t>> leaves;  // count, symbol
  for (std::size_t symbol = 0; symbol < symbols; ++symbol)
    if (counts[symbol] > 0) leaves.emplace_back(counts[symbol], symbol);
  std::ranges::sort(leaves);
  const std::size_t root = 2 * leaves.size() - 2;
  std::array<std::uint32_t, 2 * symbols> weights{};
  std::array<std::size_t, 2 * symbols> parents{};
  std::array<int, 2 * symbols> depths{};
  while (true) {
    for (std::size_t i = 0; i < leaves.size(); ++i) weights[i] = leaves[i].first;
    std::size_t leaf = 0, joined = leaves.size();
    for (std::size_t node = leaves.size(); node <= root; ++node) {
      weights[node] = 0;
      for (int child = 0; child < 2; ++child) {
        const bool takes_leaf = leaf < leaves.size() && (joined == node || weights[leaf] <= weights[joined]);
        const std::size_t taken = takes_leaf ? leaf++ : joined++;
        weights[node] += weights[taken];
        parents[taken] = node;
      }
    }
    depths[root] = 0;
    for (std::size_t node = root; node-- > 0;) depths[node] = depths[parents[node]] + 1;
    if (depths[0] <= limit) break;  // that of the rarest
    for (auto& [count, symbol] : leaves) count = (count + 1) / 2;
  }
  std::array<std::uint8_t, symbols> lengths{};
  for (std::size_t i = 0; i < leaves.size(); ++i)
    lengths[leaves[i].second] = static_cast<std::uint8_t>(depths[i]);
  return lengths;
}

/// The canonical code of these lengths (section 3.2.2), as it stands in the stream: the first bit lowest.
template <std::size_t symbols>
std::array<Bits, symbols> canonical_code(const std::array<std::uint8_t, symbols>& lengths) {
  std::array<std::uint32_t, max_bits + 2> next{};
  for (const std::uint8_t length : lengths)
    if (length > 0) ++next[length + 1U];
  for (std::size_t bits = 1; bits < next.size(); ++bits) next[bits] = (next[bits] + next[bits - 1]) << 1U;
  std::array<Bits, symbols> code{};
  for (std::size_t symbol = 0; symbol < symbols; ++symbol) {
    const std::uint32_t length = lengths[symbol];
    if (length == 0) continue;
    std::uint32_t bits = next[length]++;
    for (std::uint32_t i = 0; i < length; ++i, bits >>= 1U)
      code[symbol].value = code[symbol].value << 1U | (bits & 1U);
    code[symbol].count = length;
  }
  return code;
}

/// Writes bits behind one another.
class BitWriter {
 public:
  explicit BitWriter(std::vector<std::byte>& stream) : stream_(stream) {}

  /// Up to 32 bits.
  void put(Bits bits) {
    bits_ |= static_cast<std::uint64_t>(bits.value) << count_;
    count_ += bits.count;
    if (count_ < 32) return;
    std::array<std::byte, 4> four{};
    for (std::byte& byte : four) {
      byte = static_cast<std::byte>(bits_ & 0xffU);
      bits_ >>= 8U;
    }
    stream_.insert(stream_.end(), four.begin(), four.end());
    count_ -= 32;
  }
  /// Fills up the last byte.
  void end_byte() {
    for (; count_ > 0; count_ -= std::min(count_, 8U), bits_ >>= 8U)
      stream_.push_back(static_cast<std::byte>(bits_ & 0xffU));
  }

 private:
  std::vector<std::byte>& stream_;
  std::uint64_t bits_{0};
  std::uint32_t count_{0};  ///< fewer than 32
};

using Lengths = std::array<std::uint8_t, literals_and_lengths>;

/// The lengths of all codes, as symbols of a code of their own (section 3.2.7) with extra bits.
std::vector<std::pair<std::size_t, Bits>> symbols_of_lengths(const Lengths& lengths) {
  std::vector<std::uint8_t> all(lengths.begin(), lengths.end());
  all.resize(literals_and_lengths + distances);
  all[literals_and_lengths] = all.back() = 1;
  std::vector<std::pair<std::size_t, Bits>> symbols;
  for (std::size_t i = 0; i < all.size();) {
    const auto run_end = std::find_if(all.begin() + static_cast<std::ptrdiff_t>(i),
                                      all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), i + 138)),
                                      [](std::uint8_t length) { return length != 0; });
    const auto zeros = static_cast<std::uint32_t>(run_end - all.begin()) - static_cast<std::uint32_t>(i);
    if (zeros >= 11) {
      symbols.push_back({18, {zeros - 11, 7}});
    } else if (zeros >= 3) {
      symbols.push_back({17, {zeros - 3, 3}});
    } else {
      symbols.push_back({all[i], {}});
    }
    i += std::max<std::size_t>(zeros >= 3 ? zeros : 1, 1);
  }
  return symbols;
}

void write_codes(const Lengths& lengths, BitWriter& writer) {
  const std::vector<std::pair<std::size_t, Bits>> symbols = symbols_of_lengths(lengths);
  std::array<std::uint32_t, code_length_symbols> counts{};
  for (const auto& [symbol, extra] : symbols) ++counts[symbol];
  const auto lengths_of_lengths = code_lengths(counts, max_bits_of_code_lengths);
  const auto code = canonical_code(lengths_of_lengths);
  writer.put({literals_and_lengths - 257, 5});
  writer.put({distances - 1, 5});
  writer.put({code_length_symbols - 4, 4});
  for (const std::size_t symbol : {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15})
    writer.put({lengths_of_lengths[symbol], 3});
  for (const auto& [symbol, extra] : symbols) {
    writer.put(code[symbol]);
    writer.put(extra);
  }
}

std::array<std::uint32_t, literals_and_lengths> counts_of(const std::vector<Segment>& segments) {
  std::array<std::uint32_t, literals_and_lengths> counts{};
  std::array<std::uint32_t, 256> odd{};  // so that equal neighbours do not wait for each other
  for (const Segment& segment : segments) {
    for (std::size_t i = 0; i + 1 < segment.literals.size(); i += 2) {
      ++counts[std::to_integer<std::size_t>(segment.literals[i])];
      ++odd[std::to_integer<std::size_t>(segment.literals[i + 1])];
    }
    if (segment.literals.size() % 2 == 1) ++counts[std::to_integer<std::size_t>(segment.literals.back())];
    for_each_length(segment.repeated, [&](std::size_t length) { ++counts[symbol_of_length(length).first]; });
  }
  std::transform(odd.begin(), odd.end(), counts.begin(), counts.begin(), std::plus{});
  counts[end_of_block] = 1;
  return counts;
}

/// A block of the stream (section 3.2.3). @param is_last 1 of the last one
void write_coded(const std::vector<Segment>& segments, const Lengths& lengths, std::uint32_t is_last,
                 BitWriter& writer) {
  writer.put({is_last, 1});
  writer.put({2, 2});
  write_codes(lengths, writer);
  const auto code = canonical_code(lengths);
  for (const Segment& segment : segments) {
    for (const std::byte literal : segment.literals) writer.put(code[std::to_integer<std::size_t>(literal)]);
    const Bits distance = segment.distance == 1 ? Bits{0, 1} : Bits{1 | 63U << 1U, 7};  // 193 + 63 = 256
    for_each_length(segment.repeated, [&](std::size_t length) {
      const auto [symbol, extra] = symbol_of_length(length);
      writer.put(code[symbol]);
      writer.put(extra);
      writer.put(distance);
    });
  }
  writer.put(code[end_of_block]);
}

void write_stored(std::span<const std::byte> bytes, std::uint32_t is_last, std::vector<std::byte>& stream,
                  BitWriter& writer) {
  writer.put({is_last, 3});
  writer.end_byte();
  const auto size = static_cast<std::uint32_t>(bytes.size());
  writer.put({size | ~size << 16U, 32});
  stream.insert(stream.end(), bytes.begin(), bytes.end());
}

/// Whether a code saves enough of the bytes to be worth the time that it takes, and that of decoding.
bool is_worth_coding(const std::array<std::uint32_t, literals_and_lengths>& counts, const Lengths& lengths,
                     std::size_t bytes) {
  std::size_t bits = 8 * 80;  // the codes
  for (std::size_t symbol = 0; symbol < counts.size(); ++symbol) bits += counts[symbol] * lengths[symbol];
  return 20 * bits < 19 * 8 * bytes;
}

}  // namespace

std::vector<std::byte> zlib_stream(std::span<const std::byte> bytes) {
  std::vector<std::byte> stream{std::byte{0x78}, std::byte{0x01}};  // window of 32 kB, fastest
  stream.reserve(bytes.size() / 2 + 64);
  BitWriter writer(stream);
  for (std::size_t begin = 0; begin == 0 || begin < bytes.size(); begin += block_size) {
    const std::span<const std::byte> block = bytes.subspan(begin, std::min(block_size, bytes.size() - begin));
    const std::uint32_t is_last = begin + block_size >= bytes.size() ? 1 : 0;
    const std::vector<Segment> segments =
        segments_of(bytes.data(), block.data(), block.data() + block.size());
    const auto counts = counts_of(segments);
    Lengths lengths{};
    if (!block.empty()) lengths = code_lengths(counts, max_bits);
    if (!block.empty() && is_worth_coding(counts, lengths, block.size())) {
      write_coded(segments, lengths, is_last, writer);
    } else {
      write_stored(block, is_last, stream, writer);
    }
  }
  writer.end_byte();
  const std::uint32_t checksum = libdeflate_adler32(1, bytes.data(), bytes.size());
  for (const unsigned shift : {24U, 16U, 8U, 0U})
    stream.push_back(static_cast<std::byte>(checksum >> shift & 0xffU));
  return stream;
}

}  // namespace zerocount::hdf5
