#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace zerocount::hdf5 {

/// A zlib stream (RFC 1950) of these bytes, for the bytes of shuffled columns: those of counts are long runs,
/// those of row numbers ramps, those of times uneven, and the last digits of other numbers random. The stream
/// has a Huffman code for each 16 384 bytes, and of repetitions only those of the byte before and those at
/// one other distance, which is that of the last eight bytes; random bytes are stored.
///
/// Of such bytes it takes a third of the time of libdeflate's fastest level, which searches for strings that
/// recur, and less room. Where strings do recur, as in recorded samples, the stream is libdeflate's.
std::vector<std::byte> zlib_stream(std::span<const std::byte> bytes);

}  // namespace zerocount::hdf5
