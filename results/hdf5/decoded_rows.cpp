#include <algorithm>
#include <memory>
#include <utility>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "results/hdf5/chunk_filters.hpp"
#include "results/hdf5/encoded_rows.hpp"
#include "results/hdf5/hdf5_detail.hpp"
#include "results/timeline/timeline.hpp"

namespace zerocount::hdf5 {
namespace {

/// A chunk (stored block of a dataset) that a thread decodes.
struct DecodeJob {
  const FetchedRows* rows;
  std::size_t chunk;    ///< Index of the chunk in rows->chunks
  std::byte* elements;  ///< Buffer for the decoded elements of all rows
  bool damaged{false};

  void decode();
};

void DecodeJob::decode() {
  std::vector<std::byte> decoded(static_cast<std::size_t>(rows->shape.rows) * rows->row_size);
  damaged =
      !decode_chunk(rows->shape.filters, rows->source->bytes_of(StoredChunk(rows->chunks[chunk])), decoded);
  const std::int64_t begins =
      (rows->first / rows->shape.rows + static_cast<std::int64_t>(chunk)) * rows->shape.rows;
  const std::int64_t first = std::max(begins, rows->first);
  const std::int64_t end = std::min(begins + rows->shape.rows, rows->first + rows->rows);
  std::copy_n(decoded.data() + static_cast<std::size_t>(first - begins) * rows->row_size,
              static_cast<std::size_t>(end - first) * rows->row_size,
              elements + static_cast<std::size_t>(first - rows->first) * rows->row_size);
}

}  // namespace

void RowSource::read(std::int64_t first, std::int64_t rows, void* data) const {
  const FetchedRows fetched = fetch(first, rows);
  if (fetched.chunks.empty()) {
    std::ranges::copy(fetched.elements, static_cast<std::byte*>(data));
  } else {
    std::ranges::copy(decode_rows({&fetched, 1}).front(), static_cast<std::byte*>(data));
  }
}

FetchedRows Dataset::fetch(std::int64_t first, std::int64_t rows) const {
  require_rows(first, rows);
  FetchedRows fetched{this, first, rows, row_size(element_, extent()), {}, {}, {}};
  const std::optional<ChunkShape>& shape = chunk_shape();
  if (shape && 4 * rows >= shape->rows) {  // of fewer rows the library may have the chunk in its cache
    fetched.shape = *shape;
    for (std::int64_t chunk = first - first % shape->rows; chunk < first + rows; chunk += shape->rows) {
      fetched.chunks.push_back(find_chunk(chunk));
      if (fetched.chunks.back().size == 0) break;
    }
    if (fetched.chunks.back().size > 0) return fetched;
    fetched.chunks.clear();
  }
  fetched.elements.resize(static_cast<std::size_t>(rows) * fetched.row_size);
  if (rows > 0) read_by_library(first, rows, fetched.elements.data());
  return fetched;
}

std::vector<std::vector<std::byte>> decode_rows(std::span<const FetchedRows> all,
                                                timeline::Timeline* timeline) {
  std::vector<std::vector<std::byte>> decoded;
  std::vector<DecodeJob> jobs;
  for (const FetchedRows& rows : all) {
    decoded.push_back(rows.elements);
    decoded.back().resize(static_cast<std::size_t>(rows.rows) * rows.row_size);
    for (std::size_t chunk = 0; chunk < rows.chunks.size(); ++chunk)
      jobs.push_back({&rows, chunk, decoded.back().data()});
  }
  for_each_job(jobs.size(), timeline, "decode", [&](std::size_t i) { jobs[i].decode(); });
  for (const DecodeJob& job : jobs)
    if (job.damaged) job.rows->source->fail(unreadable_values);
  return decoded;
}

std::vector<EncodedRows> stored_rows(std::span<const FetchedRows> all, timeline::Timeline* timeline) {
  std::vector<EncodedRows> stored;
  std::vector<std::pair<std::size_t, std::size_t>> jobs;  // rows, chunk
  for (const FetchedRows& rows : all) {
    for (std::size_t chunk = 0; chunk < rows.chunks.size(); ++chunk) jobs.emplace_back(stored.size(), chunk);
    stored.push_back({rows.shape, rows.rows, std::vector<EncodedChunk>(rows.chunks.size())});
  }
  for_each_job(jobs.size(), timeline, "copy", [&](std::size_t i) {
    const auto [rows, chunk] = jobs[i];
    std::vector<std::byte> bytes = all[rows].source->bytes_of(StoredChunk(all[rows].chunks[chunk]));
    if (has_valid_checksum(bytes))
      stored[rows].chunks[chunk] = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
  });
  for (const auto& [rows, chunk] : jobs)
    if (!stored[rows].chunks[chunk]) all[rows].source->fail(unreadable_values);
  return stored;
}

}  // namespace zerocount::hdf5
