#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "results/hdf5/hdf5_detail.hpp"

namespace zerocount::hdf5 {
namespace {

/// The system's error number in the library's record of its last failure, or 0. The record is the only
/// witness: errno itself has been overwritten by then.
int system_error() {
  int number = 0;
  const auto visit = [](unsigned, const H5E_error2_t* entry, void* found) -> herr_t {
    constexpr const char* mark = "errno = ";
    const char* at = entry->desc == nullptr ? nullptr : std::strstr(entry->desc, mark);
    if (at != nullptr) *static_cast<int*>(found) = std::atoi(at + std::strlen(mark));
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, visit, &number);
  return number;
}

}  // namespace

void fail_on(const Origin& origin, const std::string& path, std::string_view problem) {
  const int error = system_error();
  const std::string reason = error == 0 ? std::string(problem) : std::system_category().message(error);
  const std::string object = path == "/" ? "" : " " + path;
  if (origin.writing) {
    throw Failure(ExitCode::machine_failed,
                  fmt::format("{}: cannot write{}: {}", origin.file, object, reason));
  }
  if (error != 0) {
    throw Failure(ExitCode::machine_failed,
                  fmt::format("{}: cannot read{}: {}", origin.file, object, reason));
  }
  throw Failure(ExitCode::bad_data,
                fmt::format("{}: damaged:{}{} {}", origin.file, object, object.empty() ? "" : ":", problem));
}

Id file_type(Element element) {
  switch (element) {
    case Element::float64:
      return H5T_IEEE_F64LE;
    case Element::int64:
      return H5T_STD_I64LE;
    case Element::int32:
      return H5T_STD_I32LE;
    case Element::int8:
      return H5T_STD_I8LE;
    case Element::flag:
      return H5T_STD_U8LE;
    case Element::text:
      break;
  }
  return H5I_INVALID_HID;
}

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

Handle creation_properties(Id kind) {
  Handle properties(H5Pcreate(kind), H5Pclose);
  const unsigned order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
  H5Pset_obj_track_times(properties.get(), false);
  H5Pset_attr_creation_order(properties.get(), order);
  if (kind != H5P_DATASET_CREATE) H5Pset_link_creation_order(properties.get(), order);
  return properties;
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

void Object::fail(std::string_view problem) const {
  fail_on(*origin_, path_, problem);
}

Handle Object::own(Id id, Handle::Close close, std::string_view problem) const {
  if (id < 0) fail(problem);
  return Handle(id, close);
}

void Object::require(herr_t status, std::string_view problem) const {
  if (status < 0) fail(problem);
}

bool Object::has_attribute(const std::string& name) const {
  return H5Aexists(id(), name.c_str()) > 0;
}

void Object::write_attribute(const std::string& name, Id type, Id from, Id space, const void* data) {
  const std::string problem = fmt::format("attribute '{}'", name);
  const Handle attribute =
      own(H5Acreate2(id(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, problem);
  require(H5Awrite(attribute.get(), from, data), problem);
}

void Object::set_text(const std::string& name, const std::string& value) {
  const Handle type = text_type();
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const char* data = value.c_str();
  write_attribute(name, type.get(), type.get(), space.get(), &data);
}

void Object::set_integer(const std::string& name, std::int64_t value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  write_attribute(name, H5T_STD_I64LE, H5T_NATIVE_INT64, space.get(), &value);
}

void Object::set_unsigned(const std::string& name, std::uint64_t value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  write_attribute(name, H5T_STD_U64LE, H5T_NATIVE_UINT64, space.get(), &value);
}

void Object::set_integers(const std::string& name, Element element, std::span<const std::int64_t> values) {
  const Size size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  write_attribute(name, file_type(element), H5T_NATIVE_INT64, space.get(), values.data());
}

Handle Object::open_attribute(const std::string& name) const {
  Handle attribute = own(H5Aopen(id(), name.c_str(), H5P_DEFAULT), H5Aclose,
                         fmt::format("the attribute '{}' is missing", name));
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  if (H5Sget_simple_extent_npoints(space.get()) != 1) {
    fail(fmt::format("the attribute '{}' is not a single value", name));
  }
  return attribute;
}

std::string Object::text(const std::string& name) const {
  const Handle attribute = open_attribute(name);
  const std::string problem = fmt::format("the attribute '{}' is not a readable text", name);
  const Handle type = text_type();
  char* data = nullptr;
  require(H5Aread(attribute.get(), type.get(), &data), problem);
  std::string value = data == nullptr ? "" : data;
  H5free_memory(data);
  return value;
}

std::int64_t Object::integer(const std::string& name) const {
  const Handle attribute = open_attribute(name);
  std::int64_t value = 0;
  require(H5Aread(attribute.get(), H5T_NATIVE_INT64, &value),
          fmt::format("the attribute '{}' is not a number", name));
  return value;
}

std::uint64_t Object::unsigned_integer(const std::string& name) const {
  const Handle attribute = open_attribute(name);
  std::uint64_t value = 0;
  require(H5Aread(attribute.get(), H5T_NATIVE_UINT64, &value),
          fmt::format("the attribute '{}' is not a number", name));
  return value;
}

}  // namespace zerocount::hdf5
