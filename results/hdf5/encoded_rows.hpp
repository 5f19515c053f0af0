#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "results/hdf5/hdf5.hpp"

/// Rows of a dataset as its file will store them. They are filtered without the library, so by any thread,
/// and before there is a dataset; Dataset::write() only stores their bytes. A timeline gets the spans of what
/// any thread does; null: none.
namespace zerocount::hdf5 {

/// The chunks of a dataset that is created with this storage, as Dataset::chunk_shape() will say.
std::optional<ChunkShape> chunk_shape_of(const Storage& storage);

/// Rows from the beginning of a chunk to the end of one, or of the dataset.
struct RowsToEncode {
  ChunkShape shape;
  std::int64_t rows;
  const void* data;
};

/// The stored bytes of a chunk, which equal chunks share.
using EncodedChunk = std::shared_ptr<const std::vector<std::byte>>;

struct EncodedRows {
  ChunkShape shape;
  std::int64_t rows{0};
  std::vector<EncodedChunk> chunks;
};

/// Encodes several chunks at a time. Chunks with the same value in all elements, such as the chunks of
/// measures that no trial has, are encoded once.
std::vector<EncodedRows> encode_rows(std::span<const RowsToEncode> all,
                                     timeline::Timeline* timeline = nullptr);

/// Rows [first, first + rows), whole in the other dimensions; `data` holds elements of type element().
struct RowsToWrite {
  Dataset* dataset;
  std::int64_t first;
  std::int64_t rows;
  const void* data;
};

/// Writes rows of several datasets. Where they are whole chunks, they are encoded, and only the calls of the
/// library run one after the other. Other rows are left to the library. The file holds the same values.
void write_rows(std::span<const RowsToWrite> all, timeline::Timeline* timeline = nullptr);

// Rows as their file stores them: RowSource::fetch() finds them, and any thread reads and decodes their
// bytes.

struct FetchedRows {
  const RowSource* source{nullptr};
  std::int64_t first{0};
  std::int64_t rows{0};
  std::size_t row_size{0};          ///< Size of a row, bytes
  ChunkShape shape{};               ///< Shape of the chunks, if there are any
  std::vector<StoredChunk> chunks;  ///< Chunks that hold the rows
  std::vector<std::byte> elements;  ///< Elements of the rows, if the library had to decode them
};

/// The elements of the rows. Decodes several chunks at a time.
/// @param timeline gets the spans; null: none
/// @throws Failure (bad_data) if stored bytes are damaged
/// @throws Failure (machine_failed) if they cannot be read
std::vector<std::vector<std::byte>> decode_rows(std::span<const FetchedRows> all,
                                                timeline::Timeline* timeline = nullptr);

/// The rows as they are stored, to be written to a dataset with the same chunks. They must begin where a
/// chunk does, and end where one or the source ends. Checks the checksums of several chunks at a time.
/// @throws as decode_rows()
std::vector<EncodedRows> stored_rows(std::span<const FetchedRows> all,
                                     timeline::Timeline* timeline = nullptr);

}  // namespace zerocount::hdf5
