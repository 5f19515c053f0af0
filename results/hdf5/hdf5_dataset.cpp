#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "results/hdf5/chunk_transfer.hpp"
#include "results/hdf5/hdf5_detail.hpp"

namespace zerocount::hdf5 {
namespace {

/// An entry of the list in which a scale names the datasets that it is attached to.
struct ScaleUse {
  hobj_ref_t dataset;
  int dimension;
};

/// The list of a scale; empty if it has none that can be read. H5DSis_attached opens every dataset of this
/// list, for each dataset anew, which takes longer than a small study.
std::vector<ScaleUse> uses_of_scale(Id scale) {
  constexpr const char* name = "REFERENCE_LIST";
  if (H5Aexists(scale, name) <= 0) return {};
  const Id opened = H5Aopen(scale, name, H5P_DEFAULT);
  if (opened < 0) return {};
  const Handle attribute(opened, H5Aclose);
  const Handle space = made(H5Aget_space(attribute.get()), H5Sclose);
  const hssize_t size = H5Sget_simple_extent_npoints(space.get());
  const Handle type = made(H5Tcreate(H5T_COMPOUND, sizeof(ScaleUse)), H5Tclose);
  demand(H5Tinsert(type.get(), "dataset", HOFFSET(ScaleUse, dataset), H5T_STD_REF_OBJ));
  demand(H5Tinsert(type.get(), "dimension", HOFFSET(ScaleUse, dimension), H5T_NATIVE_INT));
  std::vector<ScaleUse> uses(static_cast<std::size_t>(std::max<hssize_t>(size, 0)));
  if (H5Aread(attribute.get(), type.get(), uses.data()) < 0) return {};
  return uses;
}

/// Ends H5DSiterate_scales() with 1 at the scale that `reference` refers to.
herr_t is_scale_of_reference(Id, unsigned, Id scale, void* reference) {
  hobj_ref_t found{};
  if (H5Rcreate(&found, scale, ".", H5R_OBJECT, -1) < 0) return -1;
  return found == *static_cast<const hobj_ref_t*>(reference) ? 1 : 0;
}

}  // namespace

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

void Dataset::read(std::int64_t first, std::int64_t rows, void* data) const {
  read_rows({{RowsToRead{this, first, rows, data}}});
}

void Dataset::write_by_library(std::int64_t first, std::int64_t rows, const void* data) {
  const LibraryUse use;
  const Selection selection = select(first, rows);
  require(H5Dwrite(id(), types_of(element_).memory, selection.memory.get(), selection.file.get(), H5P_DEFAULT,
                   data),
          "its values");
  const std::size_t size = static_cast<std::size_t>(rows) * row_size(element_, extent());
  written().rows.push_back({first, rows, digest_of(data, size)});
}

void Dataset::read_by_library(std::int64_t first, std::int64_t rows, void* data) const {
  const LibraryUse use;
  const Selection selection = select(first, rows);
  require(H5Dread(id(), types_of(element_).memory, selection.memory.get(), selection.file.get(), H5P_DEFAULT,
                  data),
          unreadable_values);
}

void Dataset::write_texts(std::span<const std::string> texts) {
  const LibraryUse use;
  if (texts.empty()) return;
  std::vector<const char*> data(texts.size());
  std::transform(texts.begin(), texts.end(), data.begin(),
                 [](const std::string& text) { return text.c_str(); });
  require(H5Dwrite(id(), text_type().get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()), "its texts");
  written().texts.assign(texts.begin(), texts.end());
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
  written().is_scale = true;
}

void Dataset::attach_scale(const Dataset& scale, unsigned dimension) {
  const LibraryUse use;
  require(H5DSattach_scale(id(), scale.id(), dimension), "its axis");
  written().scales.emplace_back(dimension, scale.path());
}

bool Dataset::is_scale() const {
  const LibraryUse use;
  const htri_t answer = H5DSis_scale(id());
  require(answer, "whether it is an axis cannot be read");
  return answer > 0;
}

Dataset::ScaleUses Dataset::uses_as_scale() const {
  const LibraryUse use;
  ScaleUses uses;
  for (const ScaleUse& one : uses_of_scale(id())) uses.emplace_back(one.dataset, one.dimension);
  return uses;
}

bool Dataset::has_scale(const Dataset& scale, const ScaleUses& uses, unsigned dimension) const {
  const LibraryUse use;
  constexpr const char* problem = "its axes cannot be read";
  hobj_ref_t own_reference{};
  hobj_ref_t scale_reference{};
  require(H5Rcreate(&own_reference, id(), ".", H5R_OBJECT, -1), problem);
  require(H5Rcreate(&scale_reference, scale.id(), ".", H5R_OBJECT, -1), problem);
  const int listed = H5DSiterate_scales(id(), dimension, nullptr, is_scale_of_reference, &scale_reference);
  require(listed, problem);
  const ScaleUses::value_type own_use(own_reference, static_cast<int>(dimension));
  return listed > 0 && std::find(uses.begin(), uses.end(), own_use) != uses.end();
}

}  // namespace zerocount::hdf5
