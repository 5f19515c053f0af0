#include "results/hdf5/chunk_transfer.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "results/hdf5/chunk_filters.hpp"
#include "results/hdf5/encoded_rows.hpp"
#include "results/hdf5/file_driver.hpp"
#include "results/hdf5/hdf5_detail.hpp"
#include "results/storage/durable_file.hpp"
#include "results/timeline/timeline.hpp"

namespace zerocount::hdf5 {
namespace {

/// A chunk on its way between memory and the file.
struct ChunkJob {
  std::size_t request;  ///< index of its request
  std::int64_t offset;  ///< first row, from the first row of the request
  std::int64_t rows;
  ChunkShape shape;
  StoredChunk found{};
  std::vector<std::byte> stored{};  ///< bytes of the chunk
  bool damaged{false};
};

/// Whether the rows [first, first + rows) of a dataset are whole chunks; otherwise the library must divide
/// chunks, or apply filters other than ours.
bool has_whole_chunks(const Dataset& dataset, std::int64_t first, std::int64_t rows) {
  const std::optional<ChunkShape>& shape = dataset.chunk_shape();
  return shape && rows > 0 && first % shape->rows == 0 &&
         (rows % shape->rows == 0 || first + rows == static_cast<std::int64_t>(dataset.extent()[0]));
}

/// The chunks that are these rows of a dataset; none where they are not whole chunks.
std::vector<ChunkJob> whole_chunks(const Dataset& dataset, std::size_t request, std::int64_t first,
                                   std::int64_t rows) {
  std::vector<ChunkJob> chunks;
  if (!has_whole_chunks(dataset, first, rows)) return chunks;
  const std::optional<ChunkShape>& shape = dataset.chunk_shape();
  for (std::int64_t offset = 0; offset < rows; offset += shape->rows)
    chunks.push_back({request, offset, std::min(shape->rows, rows - offset), *shape});
  return chunks;
}

void append(std::vector<ChunkJob>& all, std::vector<ChunkJob> more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// Memory for the elements of a whole chunk. The last chunk of a dataset has more rows than the dataset; the
/// others are zero, as the library fills them.
std::vector<std::byte> chunk_of(const ChunkJob& job) {
  return std::vector<std::byte>(static_cast<std::size_t>(job.shape.rows) * job.shape.row_size);
}

std::size_t bytes_in(const ChunkJob& job) {
  return static_cast<std::size_t>(job.rows) * job.shape.row_size;
}

/// Runs fetch, work and store on every chunk: work on several at a time; fetch and store, which call the
/// library, on one at a time and in order.
template <class Fetch, class Work, class Store>
void run_jobs(std::vector<ChunkJob>& jobs, const Fetch& fetch, const Work& work, const Store& store) {
  namespace tbb = oneapi::tbb;
  if (jobs.size() < 2) {
    for (ChunkJob& job : jobs) {
      fetch(job);
      work(job);
      store(job);
    }
    return;
  }
  std::mutex library;
  std::size_t next = 0;
  const auto first_stage = [&](tbb::flow_control& control) -> ChunkJob* {
    if (next == jobs.size()) {
      control.stop();
      return nullptr;
    }
    const std::lock_guard lock(library);
    fetch(jobs[next]);
    return &jobs[next++];
  };
  const auto second_stage = [&](ChunkJob* job) {
    work(*job);
    return job;
  };
  const auto third_stage = [&](ChunkJob* job) {
    const std::lock_guard lock(library);
    store(*job);
    job->stored = {};
  };
  const auto pipeline = [&] {
    tbb::parallel_pipeline(
        4 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()),
        tbb::make_filter<void, ChunkJob*>(tbb::filter_mode::serial_in_order, first_stage) &
            tbb::make_filter<ChunkJob*, ChunkJob*>(tbb::filter_mode::parallel, second_stage) &
            tbb::make_filter<ChunkJob*, void>(tbb::filter_mode::serial_in_order, third_stage));
  };
  // A thread that waits here must not begin another task meanwhile, such as a block of trials.
  tbb::this_task_arena::isolate(pipeline);
}

}  // namespace

const std::optional<ChunkShape>& Dataset::chunk_shape() const {
  if (!chunk_shape_) chunk_shape_ = read_chunk_shape();
  return *chunk_shape_;
}

std::optional<ChunkShape> Dataset::read_chunk_shape() const {
  const LibraryUse use;
  if (element_ == Element::text || std::endian::native != std::endian::little) return std::nullopt;
  const Handle properties = own(H5Dget_create_plist(id()), H5Pclose, "its properties cannot be read");
  const std::vector<Size> size = extent();
  if (size.empty() || H5Pget_layout(properties.get()) != H5D_CHUNKED) return std::nullopt;
  std::vector<Size> chunk(size.size());
  require(H5Pget_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()),
          "its chunks cannot be read");
  if (!std::equal(chunk.begin() + 1, chunk.end(), size.begin() + 1)) return std::nullopt;

  std::vector<H5Z_filter_t> filters;
  unsigned level = 0;
  for (int i = 0; i < H5Pget_nfilters(properties.get()); ++i) {
    unsigned flags = 0;
    std::size_t values = 1;
    unsigned value = 0;
    unsigned config = 0;
    filters.push_back(H5Pget_filter2(properties.get(), static_cast<unsigned>(i), &flags, &values, &value, 0,
                                     nullptr, &config));
    if (filters.back() == H5Z_FILTER_DEFLATE) level = value;
  }
  ChunkShape shape{
      static_cast<std::int64_t>(chunk[0]), row_size(element_, size), {size_of(element_), {}}, size.size()};
  if (filters == std::vector{H5Z_FILTER_FLETCHER32}) return shape;
  shape.filters.deflate_level = static_cast<int>(level);
  if (filters == std::vector{H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32}) return shape;
  return std::nullopt;
}

std::vector<Size> Dataset::place_of(std::int64_t first) const {
  std::vector<Size> place(chunk_shape() ? chunk_shape()->dimensions : extent().size(), 0);
  place[0] = static_cast<Size>(first);
  return place;
}

StoredChunk Dataset::find_chunk(std::int64_t first) const {
  const LibraryUse use;
  const std::vector<Size> place = place_of(first);
  Size size = 0;
  require(H5Dget_chunk_storage_size(id(), place.data(), &size), unreadable_values);
  if (size == 0) return {};
  StoredChunk chunk{0, size};
  std::uint32_t skipped_filters = 0;
  const auto read = [&](void* bytes) {
    require(H5Dread_chunk(id(), H5P_DEFAULT, place.data(), &skipped_filters, bytes), unreadable_values);
  };
  const storage::ByteFile& file = *origin()->bytes;
  if (file.writable()) {  // the library may not have written everything yet
    chunk.bytes.resize(size);
    read(chunk.bytes.data());
  } else {
    // H5Dget_chunk_info_by_coord() would say where the chunk is, but goes through all of them.
    const ReadNote note;
    std::byte unread{};
    read(&unread);
    if (note.size() != size || note.address() > file.size() || size > file.size() - note.address())
      fail(unreadable_values);
    chunk.address = note.address();
  }
  return skipped_filters == 0 ? std::move(chunk) : StoredChunk();
}

std::vector<std::byte> Dataset::bytes_of(StoredChunk&& chunk) const {
  if (!chunk.bytes.empty()) return std::move(chunk.bytes);
  std::vector<std::byte> bytes(chunk.size);
  if (const auto failure = origin()->bytes->read_unrecorded(chunk.address, bytes))
    storage::fail_with(file_name(), failure->action, failure->error);
  return bytes;
}

void Dataset::store_chunk(std::int64_t first, std::span<const std::byte> stored) {
  const LibraryUse use;
  const std::vector<Size> place = place_of(first);
  require(H5Dwrite_chunk(id(), H5P_DEFAULT, 0, place.data(), stored.size(), stored.data()), "its values");
}

void Dataset::write(std::int64_t first, const EncodedRows& encoded) {
  require_rows(first, encoded.rows);
  if (chunk_shape() != encoded.shape || first % encoded.shape.rows != 0)
    throw std::logic_error("rows are stored in a dataset that they were not encoded for");
  for (const EncodedChunk& chunk : encoded.chunks) {
    store_chunk(first, *chunk);
    first += encoded.shape.rows;
  }
}

void write_rows(std::span<const RowsToWrite> all, timeline::Timeline* timeline) {
  std::vector<RowsToEncode> whole;
  std::vector<const RowsToWrite*> requests;
  for (const RowsToWrite& request : all) {
    request.dataset->require_rows(request.first, request.rows);
    if (!has_whole_chunks(*request.dataset, request.first, request.rows)) {
      request.dataset->write_by_library(request.first, request.rows, request.data);
      continue;
    }
    whole.push_back({*request.dataset->chunk_shape(), request.rows, request.data});
    requests.push_back(&request);
  }
  const std::vector<EncodedRows> encoded = encode_rows(whole, timeline);
  for (std::size_t i = 0; i < encoded.size(); ++i)
    requests[i]->dataset->write(requests[i]->first, encoded[i]);
}

void read_rows(std::span<const RowsToRead> all, timeline::Timeline* timeline) {
  std::vector<ChunkJob> jobs;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].dataset->require_rows(all[i].first, all[i].rows);
    std::vector<ChunkJob> chunks = whole_chunks(*all[i].dataset, i, all[i].first, all[i].rows);
    if (chunks.empty()) all[i].dataset->read_by_library(all[i].first, all[i].rows, all[i].data);
    append(jobs, std::move(chunks));
  }
  const auto target_of = [&](const ChunkJob& job) {
    return static_cast<std::byte*>(all[job.request].data) +
           static_cast<std::size_t>(job.offset) * job.shape.row_size;
  };
  const auto fetch = [&](ChunkJob& job) {
    const RowsToRead& request = all[job.request];
    job.found = request.dataset->find_chunk(request.first + job.offset);
    if (job.found.size == 0)
      request.dataset->read_by_library(request.first + job.offset, job.rows, target_of(job));
  };
  const auto decode = [&](ChunkJob& job) {
    if (job.found.size == 0) return;
    const timeline::TimeSpan span(timeline, "decode", timeline::Work::parallel);
    std::vector<std::byte> elements = chunk_of(job);
    job.damaged =
        !decode_chunk(job.shape.filters, all[job.request].dataset->bytes_of(std::move(job.found)), elements);
    std::copy_n(elements.begin(), bytes_in(job), target_of(job));
  };
  const auto check = [&](const ChunkJob& job) {
    if (job.damaged) all[job.request].dataset->fail(unreadable_values);
  };
  run_jobs(jobs, fetch, decode, check);
}

bool have_same_chunks(const RowsToCopy& copy) {
  const std::vector<ChunkJob> target = whole_chunks(*copy.dataset, 0, copy.first, copy.rows);
  const std::vector<ChunkJob> source = whole_chunks(*copy.source, 0, copy.source_first, copy.rows);
  return !target.empty() && !source.empty() && target.front().shape == source.front().shape;
}

void copy_rows(std::span<const RowsToCopy> all, timeline::Timeline* timeline) {
  std::vector<ChunkJob> jobs;
  for (std::size_t i = 0; i < all.size(); ++i)
    append(jobs, whole_chunks(*all[i].source, i, all[i].source_first, all[i].rows));
  const auto fetch = [&](ChunkJob& job) {
    const RowsToCopy& request = all[job.request];
    job.found = request.source->find_chunk(request.source_first + job.offset);
  };
  const auto check = [&](ChunkJob& job) {
    if (job.found.size == 0) return;
    const timeline::TimeSpan span(timeline, "copy", timeline::Work::parallel);
    job.stored = all[job.request].source->bytes_of(std::move(job.found));
    job.damaged = !has_valid_checksum(job.stored);
  };
  const auto store = [&](const ChunkJob& job) {
    const RowsToCopy& request = all[job.request];
    if (job.damaged) request.source->fail(unreadable_values);
    if (!job.stored.empty()) {
      request.dataset->store_chunk(request.first + job.offset, job.stored);
      return;
    }
    std::vector<std::byte> elements = chunk_of(job);
    request.source->read(request.source_first + job.offset, job.rows, elements.data());
    request.dataset->write(request.first + job.offset, job.rows, elements.data());
  };
  run_jobs(jobs, fetch, check, store);
}

}  // namespace zerocount::hdf5
