#include <algorithm>
#include <bit>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "results/hdf5/chunk_filters.hpp"
#include "results/hdf5/encoded_rows.hpp"
#include "results/hdf5/file_driver.hpp"
#include "results/hdf5/hdf5_detail.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::hdf5 {
namespace {

/// Whether the rows [first, first + rows) of a dataset are whole chunks with known filters. Otherwise the
/// HDF5 library must divide chunks, or apply filters other than those of chunk_filters.hpp.
bool has_whole_chunks(const Dataset& dataset, std::int64_t first, std::int64_t rows) {
  const std::optional<ChunkShape>& shape = dataset.chunk_shape();
  return shape && rows > 0 && first % shape->rows == 0 &&
         (rows % shape->rows == 0 || first + rows == static_cast<std::int64_t>(dataset.extent()[0]));
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

}  // namespace zerocount::hdf5
