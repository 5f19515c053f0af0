#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "core/text/text.hpp"
#include "results/hdf5/hdf5_detail.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::hdf5 {
namespace {

std::size_t attribute_size(const Handle& attribute) {
  const Handle space = made(H5Aget_space(attribute.get()), H5Sclose);
  return static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space.get())));
}

std::string place(const std::string& path) {
  return path == "/" ? "" : " " + path;
}

}  // namespace

void fail_on(Origin& origin, const std::string& path, std::string_view problem) {
  const std::string file = origin.bytes->path().string();
  if (const std::optional<storage::IoFailure>& failure = origin.bytes->failure()) {
    origin.incomplete = true;
    storage::fail_with(file, failure->action, failure->error);
  }
  if (origin.bytes->writable()) {
    origin.incomplete = true;
    throw Failure(ExitCode::machine_failed,
                  fmt::format("{}: cannot write{}: {}", file, place(path), problem));
  }
  throw Failure(ExitCode::bad_data,
                text::printable_lines(fmt::format("{}: damaged:{}{} {}", file, place(path),
                                                  place(path).empty() ? "" : ":", problem)));
}

Handle made(Id id, Handle::Close close) {
  if (id < 0) {
    throw Failure(ExitCode::machine_failed,
                  "the HDF5 library cannot make what it needs to read or write a file (out of memory?)");
  }
  return {id, close};
}

void demand(herr_t status) {
  made(status, nullptr);
}

NumberTypes types_of(Element element) {
  switch (element) {
    case Element::float64:
      return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE};
    case Element::int64:
      return {H5T_STD_I64LE, H5T_NATIVE_INT64};
    case Element::int32:
      return {H5T_STD_I32LE, H5T_NATIVE_INT32};
    case Element::int8:
      return {H5T_STD_I8LE, H5T_NATIVE_INT8};
    case Element::flag:
      return {H5T_STD_U8LE, H5T_NATIVE_UINT8};
    case Element::text:
      break;
  }
  return {H5I_INVALID_HID, H5I_INVALID_HID};
}

Handle text_type() {
  Handle type = made(H5Tcopy(H5T_C_S1), H5Tclose);
  demand(H5Tset_size(type.get(), H5T_VARIABLE));
  demand(H5Tset_cset(type.get(), H5T_CSET_UTF8));
  return type;
}

Handle creation_properties(Id kind) {
  Handle properties = made(H5Pcreate(kind), H5Pclose);
  const unsigned order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
  demand(H5Pset_obj_track_times(properties.get(), false));
  demand(H5Pset_attr_creation_order(properties.get(), order));
  if (kind != H5P_DATASET_CREATE) demand(H5Pset_link_creation_order(properties.get(), order));
  return properties;
}

void require_known_filters(Id dataset, const std::string& file, const std::string& path) {
  const Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  const int filters = H5Pget_nfilters(properties.get());
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    unsigned config = 0;
    std::size_t values = 0;
    std::array<char, 64> name{};
    const H5Z_filter_t filter = H5Pget_filter2(properties.get(), static_cast<unsigned>(i), &flags, &values,
                                               nullptr, name.size() - 1, name.data(), &config);
    if (filter < 0 || H5Zfilter_avail(filter) != 0) continue;
    throw Failure(
        ExitCode::bad_data,
        text::printable_lines(fmt::format(
            "{}: {} is stored through the HDF5 filter {} (number {}), which this program does not have; "
            "expected deflate (gzip) or no compression: write it again so, or convert it with "
            "'h5repack -f GZIP=1 OLD NEW'",
            file, path, name[0] != '\0' ? name.data() : "without a name", filter)));
  }
}

std::size_t row_size(Element element, std::span<const Size> extent) {
  std::size_t size = size_of(element);
  for (const Size length : extent.subspan(1)) size *= length;
  return size;
}

Handle::Handle(Handle&& other) noexcept
    : id_(std::exchange(other.id_, none)), close_(std::exchange(other.close_, nullptr)) {}

Handle& Handle::operator=(Handle&& other) noexcept {
  if (this != &other) {
    close();
    id_ = std::exchange(other.id_, none);
    close_ = std::exchange(other.close_, nullptr);
  }
  return *this;
}

bool Handle::close() {
  if (id_ < 0 || close_ == nullptr) return true;
  return close_(std::exchange(id_, none)) >= 0;
}

void Handle::abandon() {
  id_ = none;
}

Object& Object::operator=(Object&& other) noexcept {
  if (this != &other) {
    release();
    origin_ = std::move(other.origin_);
    handle_ = std::move(other.handle_);
    path_ = std::move(other.path_);
  }
  return *this;
}

void Object::release() noexcept {
  if (!origin_) return;
  if (origin_->broken()) handle_.abandon();
  if (!handle_.close()) origin_->incomplete = true;
}

const std::string& Object::file_name() const {
  return origin_->bytes->path().native();
}

void Object::fail(std::string_view problem) const {
  fail_on(*origin_, path_, problem);
}

Handle Object::own(Id id, Handle::Close close, std::string_view problem) const {
  if (id < 0 || origin_->bytes->failure()) fail(problem);
  return {id, close};
}

void Object::require(int status, std::string_view problem) const {
  if (status < 0 || origin_->bytes->failure()) fail(problem);
}

bool Object::has_attribute(const std::string& name) const {
  const LibraryUse use;
  const htri_t answer = H5Aexists(id(), name.c_str());
  require(answer, "its list of attributes cannot be read");
  return answer > 0;
}

void Object::write_attribute(const std::string& name, Id type, Id from, Id space, const void* data) {
  const LibraryUse use;
  const std::string problem = fmt::format("attribute '{}'", name);
  Handle attribute =
      own(H5Acreate2(id(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, problem);
  require(H5Awrite(attribute.get(), from, data), problem);
  if (!attribute.close()) fail(problem);
}

void Object::write_single(const std::string& name, Id file_type, Id memory_type, const void* data) {
  const LibraryUse use;
  const Handle space = made(H5Screate(H5S_SCALAR), H5Sclose);
  write_attribute(name, file_type, memory_type, space.get(), data);
}

void Object::set_text(const std::string& name, const std::string& value) {
  const LibraryUse use;
  const Handle type = text_type();
  const char* data = value.c_str();
  write_single(name, type.get(), type.get(), &data);
}

void Object::set_integer(const std::string& name, std::int64_t value) {
  write_single(name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

void Object::set_unsigned(const std::string& name, std::uint64_t value) {
  write_single(name, H5T_STD_U64LE, H5T_NATIVE_UINT64, &value);
}

void Object::set_integers(const std::string& name, Element element, std::span<const std::int64_t> values) {
  const LibraryUse use;
  const Size size = values.size();
  const Handle space = made(H5Screate_simple(1, &size, nullptr), H5Sclose);
  write_attribute(name, types_of(element).file, H5T_NATIVE_INT64, space.get(), values.data());
}

Handle Object::open_attribute(const std::string& name) const {
  return own(H5Aopen(id(), name.c_str(), H5P_DEFAULT), H5Aclose,
             fmt::format("the attribute '{}' is missing", name));
}

void Object::read_single(const std::string& name, Id memory_type, void* data, std::string_view kind) const {
  const LibraryUse use;
  const Handle attribute = open_attribute(name);
  if (attribute_size(attribute) != 1) fail(fmt::format("the attribute '{}' is not a single value", name));
  require(H5Aread(attribute.get(), memory_type, data),
          fmt::format("the attribute '{}' is not a {}", name, kind));
}

std::string Object::text(const std::string& name) const {
  const LibraryUse use;
  const Handle type = text_type();
  char* data = nullptr;
  read_single(name, type.get(), &data, "readable text");
  std::string value = data == nullptr ? "" : data;
  H5free_memory(data);
  return value;
}

std::vector<std::int64_t> Object::integers(const std::string& name) const {
  const LibraryUse use;
  const Handle attribute = open_attribute(name);
  std::vector<std::int64_t> values(attribute_size(attribute));
  require(H5Aread(attribute.get(), H5T_NATIVE_INT64, values.data()),
          fmt::format("the attribute '{}' is not a list of numbers", name));
  return values;
}

std::int64_t Object::integer(const std::string& name) const {
  std::int64_t value = 0;
  read_single(name, H5T_NATIVE_INT64, &value, "number");
  return value;
}

std::uint64_t Object::unsigned_integer(const std::string& name) const {
  std::uint64_t value = 0;
  read_single(name, H5T_NATIVE_UINT64, &value, "number");
  return value;
}

}  // namespace zerocount::hdf5
