#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

/// The filters that HDF5 applies to a chunk, a stored block of a dataset, implemented without the HDF5
/// library. The library is not thread-safe; these functions may run on many threads at a time.
///
/// On the way to the file, a chunk of n elements of s bytes passes through (HDF5 file format specification,
/// IV.A.2.l, "Data Storage - Filter Pipeline"):
///  1. shuffle: byte b of element i moves to position b·n + i;
///  2. deflate: a zlib stream;
///  3. Fletcher-32: the checksum of these bytes is appended, 4 bytes, little-endian.
namespace zerocount::hdf5 {

struct ChunkFilters {
  std::size_t element_size{1};
  std::optional<int> deflate_level;  ///< Compression level of the deflate filter, 0 to 9; empty: neither
                                     ///< shuffle nor deflate is applied

  bool operator==(const ChunkFilters&) const = default;
};

/// Encodes the elements of a chunk into the bytes that the HDF5 file stores. Decoding these bytes proves that
/// they are these elements, because the zlib stream ends with the Adler-32 checksum of the uncompressed data.
std::vector<std::byte> encode_chunk(const ChunkFilters& filters, std::span<const std::byte> elements);

/// Whether the stored bytes of a chunk agree with the Fletcher-32 checksum at their end.
bool has_valid_checksum(std::span<const std::byte> stored);

/// Restores the elements of a chunk. False if the stored bytes are damaged: the checksum is wrong, or they do
/// not decode to `elements.size()` bytes.
bool decode_chunk(const ChunkFilters& filters, std::span<const std::byte> stored,
                  std::span<std::byte> elements);

}  // namespace zerocount::hdf5
