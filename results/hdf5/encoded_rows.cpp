#include "results/hdf5/encoded_rows.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "results/hdf5/chunk_filters.hpp"
#include "results/hdf5/hdf5_detail.hpp"
#include "results/timeline/timeline.hpp"

namespace zerocount::hdf5 {
namespace {

/// A chunk (stored block of a dataset) that a thread encodes.
struct EncodeJob {
  const ChunkShape* shape;
  std::span<const std::byte> elements;
  /// Index of the job that encodes the chunk: this one, or an earlier one with the same bytes
  std::size_t source;
};

std::vector<EncodeJob> encode_jobs(std::span<const RowsToEncode> all) {
  std::vector<EncodeJob> jobs;
  for (const RowsToEncode& request : all) {
    const auto* const data = static_cast<const std::byte*>(request.data);
    for (std::int64_t first = 0; first < request.rows; first += request.shape.rows) {
      const std::int64_t rows = std::min(request.shape.rows, request.rows - first);
      jobs.push_back({&request.shape,
                      {data + static_cast<std::size_t>(first) * request.shape.row_size,
                       static_cast<std::size_t>(rows) * request.shape.row_size},
                      jobs.size()});
    }
  }
  return jobs;
}

bool has_one_value(std::span<const std::byte> elements, std::size_t size) {
  return std::memcmp(elements.data(), elements.data() + size, elements.size() - size) == 0;
}

void share_equal_chunks(std::vector<EncodeJob>& jobs) {
  std::vector<std::size_t> of_one_value;
  for (EncodeJob& job : jobs) {
    const std::size_t size = job.shape->filters.element_size;
    if (!has_one_value(job.elements, size)) continue;
    const auto is_same = [&](std::size_t index) {
      const EncodeJob& other = jobs[index];
      return *other.shape == *job.shape && other.elements.size() == job.elements.size() &&
             std::memcmp(other.elements.data(), job.elements.data(), size) == 0;
    };
    const auto found = std::find_if(of_one_value.begin(), of_one_value.end(), is_same);
    if (found == of_one_value.end()) {
      of_one_value.push_back(job.source);
    } else {
      job.source = *found;
    }
  }
}

EncodedChunk encoded(const EncodeJob& job) {
  // The last chunk of a dataset has more rows than the dataset; the others are zero, as the library fills
  // them.
  std::vector<std::byte> whole;
  std::span<const std::byte> elements = job.elements;
  const std::size_t size = static_cast<std::size_t>(job.shape->rows) * job.shape->row_size;
  if (elements.size() < size) {
    whole.resize(size);
    std::ranges::copy(elements, whole.begin());
    elements = whole;
  }
  std::vector<std::byte> stored = encode_chunk(job.shape->filters, elements);
  stored.shrink_to_fit();
  return std::make_shared<const std::vector<std::byte>>(std::move(stored));
}

}  // namespace

std::optional<ChunkShape> chunk_shape_of(const Storage& storage) {
  const std::vector<Size>& extent = storage.extent;
  if (storage.element == Element::text || extent.empty() ||
      !std::equal(storage.chunk.begin() + 1, storage.chunk.end(), extent.begin() + 1))
    return std::nullopt;
  ChunkShape shape{static_cast<std::int64_t>(storage.chunk[0]),
                   row_size(storage.element, extent),
                   {size_of(storage.element), {}},
                   extent.size()};
  if (storage.compression == Compression::deflate) shape.filters.deflate_level = deflate_level;
  return shape;
}

void for_each_job(std::size_t count, timeline::Timeline* timeline, std::string_view name,
                  const std::function<void(std::size_t)>& work) {
  namespace tbb = oneapi::tbb;
  const auto work_on = [&](const tbb::blocked_range<std::size_t>& range) {
    const timeline::TimeSpan span(timeline, name, timeline::Work::parallel);
    for (std::size_t index = range.begin(); index != range.end(); ++index) work(index);
  };
  // A thread that waits here must not begin another task meanwhile, such as a block of trials.
  tbb::this_task_arena::isolate(
      [&] { tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), work_on); });
}

std::vector<EncodedRows> encode_rows(std::span<const RowsToEncode> all, timeline::Timeline* timeline) {
  std::vector<EncodeJob> jobs = encode_jobs(all);
  share_equal_chunks(jobs);
  std::vector<EncodedChunk> chunks(jobs.size());
  const auto encode = [&](std::size_t index) {
    if (jobs[index].source == index) chunks[index] = encoded(jobs[index]);
  };
  for_each_job(jobs.size(), timeline, "encode", encode);

  std::vector<EncodedRows> rows;
  auto job = jobs.begin();
  for (const RowsToEncode& request : all) {
    rows.push_back({request.shape, request.rows, {}});
    for (std::int64_t first = 0; first < request.rows; first += request.shape.rows)
      rows.back().chunks.push_back(chunks[(job++)->source]);
  }
  return rows;
}

}  // namespace zerocount::hdf5
