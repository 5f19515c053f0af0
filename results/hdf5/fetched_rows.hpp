#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "results/hdf5/hdf5.hpp"

/// Rows of a dataset as its file stores them: the library finds them (Dataset::fetch), and any thread reads
/// and decodes their bytes.
namespace zerocount::hdf5 {

struct FetchedRows {
  const Dataset* dataset{nullptr};  ///< for messages
  std::int64_t first{0};
  std::int64_t rows{0};
  std::size_t row_size{0};          ///< bytes
  ChunkShape shape{};               ///< if there are chunks
  std::vector<StoredChunk> chunks;  ///< those that hold the rows
  std::vector<std::byte> elements;  ///< of the rows, where the library had to decode them
};

/// The elements of the rows. Decodes several chunks at a time.
/// @throws Failure (bad_data) if stored bytes are damaged
/// @throws Failure (machine_failed) if they cannot be read
std::vector<std::vector<std::byte>> decode_rows(std::span<const FetchedRows> all);

}  // namespace zerocount::hdf5
