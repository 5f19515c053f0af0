#include "results/hdf5/byte_deflate.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <new>
#include <string_view>
#include <utility>

#include <libdeflate.h>

// Deflate: RFC 1951; the numbers of sections are its own.
namespace zerocount::hdf5 {
namespace {

constexpr std::size_t block_size = 16384;
constexpr std::size_t end_of_block = 256;  ///< symbol
constexpr std::size_t literals_and_lengths = 286;
constexpr std::size_t distances = 30;
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
  std::size_t repeated{0};  ///< 0, or at least 3
  std::size_t distance{1};
};

std::uint64_t eight_bytes(const std::byte* from) {
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, from, sizeof bytes);
  return bytes;
}

/// Index of the first of three bytes that are 0, of eight; 8: there are none.
std::size_t first_three_zeros(std::uint64_t bytes) {
  constexpr std::uint64_t low_bits = 0x7f7f7f7f7f7f7f7f;
  const std::uint64_t zeros = ~(((bytes & low_bits) + low_bits) | bytes | low_bits);  // their highest bits
  return static_cast<std::size_t>(std::countr_zero(zeros & zeros >> 8U & zeros >> 16U)) / 8;
}

/// The distance between the last eight bytes of a block and the same ones before, or between the first two of
/// several: each design point, or each trial of a rig, repeats the draws of the one before. 2 without any.
/// @param first of the whole stream
std::size_t period_of(const std::byte* first, std::span<const std::byte> block) {
  constexpr std::ptrdiff_t window = 32768;
  constexpr std::size_t sample = 8;
  const std::byte* const end = block.data() + block.size();
  const std::byte* const begin = first + std::max<std::ptrdiff_t>(end - first - window, 0);
  const std::string_view text(reinterpret_cast<const char*>(begin), static_cast<std::size_t>(end - begin));
  if (text.size() < 2 * sample) return 2;
  const std::string_view last = text.substr(text.size() - sample);
  const std::size_t found = text.find(last);
  const std::size_t next = text.find(last, found + 1);
  return next == std::string_view::npos ? 2 : std::max<std::size_t>(next - found, 2);
}

/// Divides a block into segments. @param first of the whole stream
std::vector<Segment> segments_of(const std::byte* first, std::span<const std::byte> block,
                                 std::size_t period) {
  constexpr std::ptrdiff_t step = 8;
  const std::byte* const end = block.data() + block.size();
  std::vector<Segment> segments;
  const std::byte* literals = block.data();
  const auto distance = static_cast<std::ptrdiff_t>(period);
  const auto begin = [&](const std::byte* at, const std::byte* after, std::size_t by) {
    segments.push_back({{literals, at}, static_cast<std::size_t>(after - at), by});
    literals = after;
    return after;
  };
  const auto run_end = [&](const std::byte* at) {
    const std::byte* after = at;
    while (end - after >= step && eight_bytes(after) == eight_bytes(after - 1)) after += step;
    while (after < end && *after == after[-1]) ++after;
    return after;
  };
  for (const std::byte* at = block.data() + (block.data() == first ? 1 : 0); end - at >= step;) {
    const std::byte* const run = at + first_three_zeros(eight_bytes(at) ^ eight_bytes(at - 1));
    if (run < at + step) {
      at = begin(run, run_end(run), 1);
      continue;
    }
    const std::byte* after = at;
    while (after - first >= distance && end - after >= step &&
           eight_bytes(after) == eight_bytes(after - distance))
      after += step;
    at = after > at ? begin(at, after, period) : at + step;
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

/// Symbol of a distance, and its extra bits.
std::pair<std::size_t, Bits> symbol_of_distance(std::size_t distance) {
  const auto above_shortest = static_cast<std::uint32_t>(distance - 1);
  if (above_shortest < 2) return {above_shortest, {}};
  const std::uint32_t extra = static_cast<std::uint32_t>(std::bit_width(above_shortest)) - 2;
  return {2 + 2 * extra + (above_shortest >> extra & 1U), {above_shortest & ((1U << extra) - 1), extra}};
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

Bits joined(const Bits& first, const Bits& second) {
  return {first.value | second.value << first.count, first.count + second.count};
}

/// Writes bits behind one another into memory that is large enough, and has eight bytes to spare.
class BitWriter {
 public:
  explicit BitWriter(std::byte* to) : to_(to) {}

  /// Up to 32 bits.
  void put(const Bits& bits) {
    bits_ |= static_cast<std::uint64_t>(bits.value) << count_;
    count_ += bits.count;
    std::memcpy(to_, &bits_, sizeof bits_);
    to_ += count_ / 8;
    bits_ >>= count_ / 8 * 8;
    count_ %= 8;
  }
  /// Begins a byte.
  void end_byte() { put({0, (8 - count_) % 8}); }
  /// Whole bytes, where a byte begins.
  void put(std::span<const std::byte> bytes) { to_ = std::ranges::copy(bytes, to_).out; }
  const std::byte* end() const { return to_; }

 private:
  std::byte* to_;
  std::uint64_t bits_{0};
  std::uint32_t count_{0};  ///< fewer than 8
};

using Lengths = std::array<std::uint8_t, literals_and_lengths>;
using Counts = std::array<std::uint32_t, literals_and_lengths>;

/// The lengths of all codes, as symbols of a code of their own (section 3.2.7) with extra bits.
std::vector<std::pair<std::size_t, Bits>> symbols_of_lengths(const Lengths& lengths, std::size_t period) {
  std::vector<std::uint8_t> all(lengths.begin(), lengths.end());
  all.resize(literals_and_lengths + distances);
  all[literals_and_lengths] = 1;
  all[literals_and_lengths + symbol_of_distance(period).first] = 1;
  std::vector<std::pair<std::size_t, Bits>> symbols;
  for (std::size_t i = 0; i < all.size();) {
    const auto run_end =
        std::find_if(all.begin() + static_cast<std::ptrdiff_t>(i),
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

void write_codes(const Lengths& lengths, std::size_t period, BitWriter& writer) {
  const std::vector<std::pair<std::size_t, Bits>> symbols = symbols_of_lengths(lengths, period);
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

Counts counts_of(const std::vector<Segment>& segments) {
  Counts counts{};
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
void write_coded(const std::vector<Segment>& segments, std::size_t period, const Lengths& lengths,
                 std::uint32_t is_last, BitWriter& writer) {
  writer.put({is_last, 1});
  writer.put({2, 2});
  write_codes(lengths, period, writer);
  const Bits of_period = joined({1, 1}, symbol_of_distance(period).second);
  const auto code = canonical_code(lengths);
  for (const Segment& segment : segments) {
    const auto code_of = [&](std::size_t i) {
      return code[std::to_integer<std::size_t>(segment.literals[i])];
    };
    const std::size_t in_pairs = segment.literals.size() / 2 * 2;
    for (std::size_t i = 0; i < in_pairs; i += 2) writer.put(joined(code_of(i), code_of(i + 1)));
    if (in_pairs < segment.literals.size()) writer.put(code_of(in_pairs));
    const Bits distance = segment.distance == 1 ? Bits{0, 1} : of_period;
    for_each_length(segment.repeated, [&](std::size_t length) {
      const auto [symbol, extra] = symbol_of_length(length);
      writer.put(code[symbol]);
      writer.put(extra);
      writer.put(distance);
    });
  }
  writer.put(code[end_of_block]);
}

void write_stored(std::span<const std::byte> bytes, std::uint32_t is_last, BitWriter& writer) {
  writer.put({is_last, 3});
  writer.end_byte();
  const auto size = static_cast<std::uint32_t>(bytes.size());
  writer.put({size | ~size << 16U, 32});
  writer.put(bytes);
}

/// Whether no code of these bytes saves a twentieth: with relative frequencies pᵢ, a code takes at least
/// −Σpᵢ·log₂pᵢ ≥ −log₂Σpᵢ² bits a byte (the Rényi entropies of order 1 and 2).
bool are_random(const Counts& counts, std::size_t bytes) {
  std::uint64_t squares = 0;
  for (std::size_t byte = 0; byte < 256; ++byte) squares += std::uint64_t{counts[byte]} * counts[byte];
  constexpr std::uint64_t of_bits = 194;  // 2^7.6
  return squares * of_bits < std::uint64_t{bytes} * bytes;
}

/// Literals and the bits that their code takes.
struct LiteralCode {
  std::size_t bytes{0};
  std::size_t bits{0};
};
LiteralCode literal_code(const Counts& counts, const Lengths& lengths) {
  LiteralCode code;
  for (std::size_t literal = 0; literal < end_of_block; ++literal) {
    code.bytes += counts[literal];
    code.bits += std::size_t{counts[literal]} * lengths[literal];
  }
  return code;
}

/// The stream of libdeflate at its fastest level.
std::vector<std::byte> searched_stream(std::span<const std::byte> bytes) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(1), libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::vector<std::byte> stream(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
  stream.resize(
      libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), stream.data(), stream.size()));
  return stream;
}

/// Whether a code saves enough to be worth the time that it takes, and that of decoding.
bool is_worth_coding(const Counts& counts, const Lengths& lengths, std::size_t bytes) {
  std::size_t bits = std::size_t{8} * 80;  // the codes
  for (std::size_t symbol = 0; symbol < counts.size(); ++symbol)
    bits += std::size_t{counts[symbol]} * lengths[symbol];
  return 20 * bits < std::size_t{19} * 8 * bytes;
}

/// Whether many of the literals stand in strings of eight that occurred before, as in recorded samples. Of
/// all strings a sixteenth is looked at, which their bits choose.
bool recur(const std::vector<Segment>& segments) {
  constexpr int places_log2 = 10;
  constexpr std::uint64_t golden_ratio = 0x9e3779b97f4a7c15;
  std::array<std::uint64_t, std::size_t{1} << places_log2> seen{};
  std::size_t strings = 0, found = 0;
  for (const Segment& segment : segments) {
    for (std::size_t i = 0; i + 8 <= segment.literals.size(); ++i) {
      const std::uint64_t string = eight_bytes(segment.literals.data() + i);
      const std::uint64_t hash = string * golden_ratio >> (60 - places_log2);
      if (hash % 16 != 0) continue;
      std::uint64_t& before = seen[hash / 16];
      ++strings;
      found += before == string;
      before = string;
    }
  }
  return 10 * found > strings;
}

/// False if a search for strings that recur would save much: nothing is written then.
/// @param to_examine number of further blocks whose strings are examined: values that recur do so in all
/// bytes
bool write_block(const std::byte* first, std::span<const std::byte> block, std::uint32_t is_last,
                 int& to_examine, BitWriter& writer) {
  const auto store = [&] {
    write_stored(block, is_last, writer);
    return true;
  };
  const std::size_t period = period_of(first, block);
  const std::vector<Segment> segments = segments_of(first, block, period);
  const Counts counts = counts_of(segments);
  if (segments.size() == 1 && are_random(counts, block.size())) return store();
  const Lengths lengths = code_lengths(counts, max_bits);
  const LiteralCode literals = literal_code(counts, lengths);
  constexpr std::size_t bits_of_repetition = 3;  // of each byte: a length and a distance for eight
  if (to_examine > 0 && literals.bits > bits_of_repetition * literals.bytes &&
      8 * literals.bytes > block.size()) {
    --to_examine;
    if (recur(segments)) return false;
  }
  if (!is_worth_coding(counts, lengths, block.size())) return store();
  write_coded(segments, period, lengths, is_last, writer);
  return true;
}

}  // namespace

std::vector<std::byte> zlib_stream(std::span<const std::byte> bytes) {
  if (bytes.size() < block_size) return searched_stream(bytes);  // which takes little time
  constexpr std::size_t max_bytes_of_codes = 700;
  std::vector<std::byte> stream(bytes.size() + (bytes.size() / block_size + 1) * max_bytes_of_codes);
  BitWriter writer(stream.data());
  writer.put({0x0178, 16});  // window of 32 kB, fastest
  int to_examine = 2;
  for (std::size_t begin = 0; begin < bytes.size(); begin += block_size) {
    const std::span<const std::byte> block = bytes.subspan(begin, std::min(block_size, bytes.size() - begin));
    const std::uint32_t is_last = begin + block_size >= bytes.size() ? 1 : 0;
    if (!write_block(bytes.data(), block, is_last, to_examine, writer)) return searched_stream(bytes);
  }
  writer.end_byte();
  const std::uint32_t checksum = libdeflate_adler32(1, bytes.data(), bytes.size());
  for (const unsigned shift : {24U, 16U, 8U, 0U}) writer.put({checksum >> shift & 0xffU, 8});
  stream.resize(static_cast<std::size_t>(writer.end() - stream.data()));
  return stream;
}

}  // namespace zerocount::hdf5
