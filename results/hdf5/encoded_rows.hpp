#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "results/hdf5/hdf5.hpp"

/// Rows of a dataset in the bytes that its file will store. They are compressed without the HDF5 library, so
/// by any thread, and before the dataset exists; Dataset::write() only stores their bytes. A function with a
/// `timeline` records in it which thread worked at what time; null: nothing is recorded.
namespace zerocount::hdf5 {

/// Shape of the chunks (stored blocks of rows) of a dataset that is created with this storage, as
/// Dataset::chunk_shape() will give it; empty where that would be empty.
std::optional<ChunkShape> chunk_shape_of(const Storage& storage);

/// Rows of a dataset that are to be encoded. They begin at the beginning of a chunk, and end at the end of a
/// chunk or of the dataset.
struct RowsToEncode {
  ChunkShape shape;
  std::int64_t rows;
  const void* data;
};

/// The encoded bytes of a chunk as the file stores them. Chunks with equal contents share one copy.
using EncodedChunk = std::shared_ptr<const std::vector<std::byte>>;

struct EncodedRows {
  ChunkShape shape;
  std::int64_t rows{0};
  std::vector<EncodedChunk> chunks;
};

/// Encodes the chunks of all these rows, several at a time on several threads. Chunks with the same value in
/// all elements, such as the chunks of measures that no trial has, are encoded once.
/// @returns one entry for each entry of `all`.
/// @param timeline records the threads' work; null: no record.
std::vector<EncodedRows> encode_rows(std::span<const RowsToEncode> all,
                                     timeline::Timeline* timeline = nullptr);

/// Rows [first, first + rows) of a dataset that are to be written, whole in the other dimensions. `data`
/// points to elements of the dataset's type.
struct RowsToWrite {
  Dataset* dataset;
  std::int64_t first;
  std::int64_t rows;
  const void* data;
};

/// Writes rows of several datasets. Rows that fill whole chunks are encoded on several threads, and only the
/// calls of the HDF5 library run one after the other. The library itself encodes the other rows. The file
/// holds the same values either way.
/// @param timeline records the threads' work; null: no record.
void write_rows(std::span<const RowsToWrite> all, timeline::Timeline* timeline = nullptr);

// Rows as their file stores them: RowSource::fetch() finds them, and any thread reads and decodes their
// bytes.

struct FetchedRows {
  const RowSource* source{nullptr};
  std::int64_t first{0};
  std::int64_t rows{0};
  std::size_t row_size{0};          ///< Size of one row in memory, bytes
  ChunkShape shape{};               ///< Shape of the chunks in which the rows are stored; unused if
                                    /// < `elements` holds the rows
  std::vector<StoredChunk> chunks;  ///< The chunks that contain the rows, in order
  std::vector<std::byte> elements;  ///< The decoded rows, if the HDF5 library had to decode them; otherwise
                                    /// < empty
};

/// Decodes fetched rows, several chunks at a time on several threads.
/// @returns the bytes of the rows' elements, one entry for each entry of `all`.
/// @param timeline records the threads' work; null: no record
/// @throws Failure (bad_data) if stored bytes are damaged
/// @throws Failure (machine_failed) if they cannot be read
std::vector<std::vector<std::byte>> decode_rows(std::span<const FetchedRows> all,
                                                timeline::Timeline* timeline = nullptr);

/// Turns fetched rows into encoded rows without decoding them, to be written to a dataset with the same
/// chunks. The rows must begin where a chunk does, and end where a chunk or the source ends. Checks the
/// checksums of several chunks at a time.
/// @param timeline records the threads' work; null: no record.
/// @throws as decode_rows()
std::vector<EncodedRows> stored_rows(std::span<const FetchedRows> all,
                                     timeline::Timeline* timeline = nullptr);

}  // namespace zerocount::hdf5
