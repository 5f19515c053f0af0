#include "results/hdf5/fetched_rows.hpp"

#include <algorithm>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "results/hdf5/chunk_filters.hpp"
#include "results/hdf5/hdf5_detail.hpp"

namespace zerocount::hdf5 {
namespace {

/// A chunk to decode.
struct DecodeJob {
  const FetchedRows* rows;
  std::size_t chunk;    ///< index in rows->chunks
  std::byte* elements;  ///< of all rows
  bool damaged{false};
};

void decode(DecodeJob& job) {
  const FetchedRows& rows = *job.rows;
  std::vector<std::byte> elements(static_cast<std::size_t>(rows.shape.rows) * rows.row_size);
  job.damaged = !decode_chunk(rows.shape.filters, rows.chunks[job.chunk], elements);
  const std::int64_t begins =
      (rows.first / rows.shape.rows + static_cast<std::int64_t>(job.chunk)) * rows.shape.rows;
  const std::int64_t first = std::max(begins, rows.first);
  const std::int64_t end = std::min(begins + rows.shape.rows, rows.first + rows.rows);
  std::copy_n(elements.data() + static_cast<std::size_t>(first - begins) * rows.row_size,
              static_cast<std::size_t>(end - first) * rows.row_size,
              job.elements + static_cast<std::size_t>(first - rows.first) * rows.row_size);
}

}  // namespace

FetchedRows Dataset::fetch(std::int64_t first, std::int64_t rows) const {
  require_rows(first, rows);
  FetchedRows fetched{this, first, rows, row_size(element_, extent()), {}, {}, {}};
  const std::optional<ChunkShape>& shape = chunk_shape();
  if (shape && 4 * rows >= shape->rows) {  // of fewer rows the library may have the chunk in its cache
    fetched.shape = *shape;
    for (std::int64_t chunk = first - first % shape->rows; chunk < first + rows; chunk += shape->rows) {
      fetched.chunks.push_back(stored_chunk(chunk));
      if (fetched.chunks.back().empty()) break;
    }
    if (!fetched.chunks.back().empty()) return fetched;
    fetched.chunks.clear();
  }
  fetched.elements.resize(static_cast<std::size_t>(rows) * fetched.row_size);
  if (rows > 0) read_by_library(first, rows, fetched.elements.data());
  return fetched;
}

std::vector<std::vector<std::byte>> decode_rows(std::span<const FetchedRows> all) {
  namespace tbb = oneapi::tbb;
  std::vector<std::vector<std::byte>> decoded;
  std::vector<DecodeJob> jobs;
  for (const FetchedRows& rows : all) {
    decoded.push_back(rows.elements);
    decoded.back().resize(static_cast<std::size_t>(rows.rows) * rows.row_size);
    for (std::size_t chunk = 0; chunk < rows.chunks.size(); ++chunk)
      jobs.push_back({&rows, chunk, decoded.back().data()});
  }
  // A thread that waits here must not begin another task meanwhile, such as a block of trials.
  tbb::this_task_arena::isolate(
      [&] { tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) { decode(jobs[i]); }); });
  for (const DecodeJob& job : jobs)
    if (job.damaged) job.rows->dataset->fail(unreadable_values);
  return decoded;
}

}  // namespace zerocount::hdf5
