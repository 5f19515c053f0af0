#pragma once

#include <cstdint>
#include <span>

#include "results/hdf5/hdf5.hpp"

/// Rows of several datasets at a time. Where the rows are whole chunks, their filters run in parallel tasks
/// (see chunk_filters.hpp), and only the calls of the library run one after the other. Other rows are left to
/// the library. The file holds the same values either way. A timeline gets the spans of what any thread does.
namespace zerocount::hdf5 {

/// Rows [first, first + rows), whole in the other dimensions; `data` holds elements of type element().
struct RowsToWrite {
  Dataset* dataset;
  std::int64_t first;
  std::int64_t rows;
  const void* data;
};
void write_rows(std::span<const RowsToWrite> all, timeline::Timeline* timeline = nullptr);

struct RowsToRead {
  const Dataset* dataset;
  std::int64_t first;
  std::int64_t rows;
  void* data;
};
void read_rows(std::span<const RowsToRead> all, timeline::Timeline* timeline = nullptr);

/// Rows [source_first, source_first + rows) of `source`, to the rows from `first` on of `dataset`.
struct RowsToCopy {
  Dataset* dataset;
  std::int64_t first;
  std::int64_t rows;
  const Dataset* source;
  std::int64_t source_first;
};

/// Whether both datasets store the rows in whole chunks of the same size and with the same filters.
bool have_same_chunks(const RowsToCopy& copy);

/// Copies the chunks as they are stored, after checking their checksums.
/// @param all have_same_chunks() of each
void copy_rows(std::span<const RowsToCopy> all, timeline::Timeline* timeline = nullptr);

}  // namespace zerocount::hdf5
