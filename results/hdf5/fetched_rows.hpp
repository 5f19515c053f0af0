#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "results/hdf5/encoded_rows.hpp"
#include "results/hdf5/hdf5.hpp"

/// Rows as their file stores them: RowSource::fetch() finds them, and any thread reads and decodes their
/// bytes.
namespace zerocount::hdf5 {

struct FetchedRows {
  const RowSource* source{nullptr};
  std::int64_t first{0};
  std::int64_t rows{0};
  std::size_t row_size{0};          ///< bytes
  ChunkShape shape{};               ///< if there are chunks
  std::vector<StoredChunk> chunks;  ///< those that hold the rows
  std::vector<std::byte> elements;  ///< of the rows, where the library had to decode them
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
