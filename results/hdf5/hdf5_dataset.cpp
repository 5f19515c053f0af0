#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "results/hdf5/encoded_rows.hpp"
#include "results/hdf5/hdf5_detail.hpp"

namespace zerocount::hdf5 {

Dataset::Dataset(Handle handle, std::shared_ptr<Origin> origin, std::string path)
    : Object(std::move(handle), std::move(origin), std::move(path)), element_(stored_element()) {}

Element Dataset::stored_element() const {
  const Handle type = own(H5Dget_type(id()), H5Tclose, "its type cannot be read");
  if (H5Tis_variable_str(type.get()) > 0) return Element::text;
  for (const Element element :
       {Element::float64, Element::int64, Element::int32, Element::int8, Element::flag}) {
    if (H5Tequal(type.get(), types_of(element).file) > 0) return element;
  }
  fail("its elements have an unexpected type");
}

std::vector<Size> Dataset::extent() const {
  const LibraryUse use;
  const Handle space = own(H5Dget_space(id()), H5Sclose, "its size cannot be read");
  const int rank = H5Sget_simple_extent_ndims(space.get());
  require(rank, "its number of dimensions cannot be read");
  std::vector<Size> extent(static_cast<std::size_t>(rank));
  require(H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr), "its size cannot be read");
  return extent;
}

void Dataset::require_rows(std::int64_t first, std::int64_t rows) const {
  const std::vector<Size> count = extent();
  if (count.empty() || first < 0 || rows < 0 ||
      static_cast<Size>(first) + static_cast<Size>(rows) > count[0]) {
    fail(fmt::format("it has {} rows; rows {} to {} were expected", count.empty() ? 0 : count[0], first,
                     first + rows));
  }
}

Dataset::Selection Dataset::select(std::int64_t first, std::int64_t rows) const {
  std::vector<Size> count = extent();
  count[0] = static_cast<Size>(rows);
  std::vector<Size> start(count.size(), 0);
  start[0] = static_cast<Size>(first);
  Selection selection{
      own(H5Dget_space(id()), H5Sclose, "its size cannot be read"),
      made(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose)};
  require(
      H5Sselect_hyperslab(selection.file.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
      "its rows cannot be selected");
  return selection;
}

void Dataset::write(std::int64_t first, std::int64_t rows, const void* data) {
  write_rows({{RowsToWrite{this, first, rows, data}}});
}

void Dataset::write_by_library(std::int64_t first, std::int64_t rows, const void* data) {
  const LibraryUse use;
  const Selection selection = select(first, rows);
  require(H5Dwrite(id(), types_of(element_).memory, selection.memory.get(), selection.file.get(), H5P_DEFAULT,
                   data),
          "its values");
}

void Dataset::read_by_library(std::int64_t first, std::int64_t rows, void* data) const {
  const LibraryUse use;
  const Selection selection = select(first, rows);
  const herr_t status = H5Dread(id(), types_of(element_).memory, selection.memory.get(), selection.file.get(),
                                H5P_DEFAULT, data);
  if (status < 0) require_known_filters(id(), file_name(), path());
  require(status, unreadable_values);
}

void Dataset::write_texts(std::span<const std::string> texts) {
  const LibraryUse use;
  if (texts.empty()) return;
  std::vector<const char*> data(texts.size());
  std::transform(texts.begin(), texts.end(), data.begin(),
                 [](const std::string& text) { return text.c_str(); });
  require(H5Dwrite(id(), text_type().get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()), "its texts");
}

std::vector<std::string> Dataset::read_texts() const {
  const LibraryUse use;
  if (element_ != Element::text) fail("its elements are not texts");
  const Handle space = own(H5Dget_space(id()), H5Sclose, "its size cannot be read");
  const hssize_t size = H5Sget_simple_extent_npoints(space.get());
  if (size < 0) fail("its size cannot be read");
  std::vector<char*> data(static_cast<std::size_t>(size), nullptr);
  if (data.empty()) return {};
  const Handle type = text_type();
  require(H5Dread(id(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()),
          "its texts cannot be read or their checksum is wrong");
  std::vector<std::string> texts(data.size());
  std::transform(data.begin(), data.end(), texts.begin(),
                 [](const char* text) { return text == nullptr ? "" : text; });
  require(H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, data.data()), "its texts cannot be read");
  return texts;
}

void Dataset::make_scale(const std::string& name) {
  const LibraryUse use;
  require(H5DSset_scale(id(), name.c_str()), "its name as an axis");
}

void Dataset::attach_scale(const Dataset& scale, unsigned dimension) {
  const LibraryUse use;
  require(H5DSattach_scale(id(), scale.id(), dimension), "its axis");
}

}  // namespace zerocount::hdf5
