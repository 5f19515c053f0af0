#include "results/hdf5.hpp"

#include <H5DSpublic.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

namespace zerocount::hdf5 {
namespace {

/// Level of deflate: the inputs of trials are random digits, which higher levels only spend time on.
constexpr unsigned deflate_level = 4;

/// No text of the library on stderr, and no work of its own at exit, where it would retry writes that have failed.
void quieten() {
  static const herr_t no_work_at_exit = H5dont_atexit();
  static_cast<void>(no_work_at_exit);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // a setting of the calling thread
}

/// The system's error number in the library's record of its last failure, or 0. The record is the only witness: errno
/// itself has been overwritten by then.
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

[[noreturn]] void fail_on(const Origin& origin, const std::string& path, std::string_view problem) {
  const int error = system_error();
  const std::string reason = error == 0 ? std::string{} : std::system_category().message(error);
  if (origin.writing) {
    throw Failure(ExitCode::machine_failed,
                  fmt::format("{}: cannot write {}: {}", origin.file, path, error == 0 ? problem : reason));
  }
  if (error != 0) {
    throw Failure(ExitCode::machine_failed, fmt::format("{}: cannot read {}: {}", origin.file, path, reason));
  }
  throw Failure(ExitCode::bad_data, fmt::format("{}: damaged: {}: {}", origin.file, path, problem));
}

hid_t file_type(Element element) {
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

hid_t memory_type(Element element) {
  switch (element) {
    case Element::float64:
      return H5T_NATIVE_DOUBLE;
    case Element::int64:
      return H5T_NATIVE_INT64;
    case Element::int32:
      return H5T_NATIVE_INT32;
    case Element::int8:
      return H5T_NATIVE_INT8;
    case Element::flag:
      return H5T_NATIVE_UINT8;
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

Handle creation_properties(hid_t kind) {
  Handle properties(H5Pcreate(kind), H5Pclose);
  const unsigned order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
  H5Pset_obj_track_times(properties.get(), false);
  H5Pset_attr_creation_order(properties.get(), order);
  if (kind != H5P_DATASET_CREATE) H5Pset_link_creation_order(properties.get(), order);
  return properties;
}

/// Object headers of version 2 carry checksums; later formats would lock out readers built on HDF5 1.8. Files are
/// immutable once they have their name, so the library's own file locks (which fail on some cluster file systems) are off.
Handle access_properties() {
  Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(properties.get(), H5F_LIBVER_V18, H5F_LIBVER_V18);
  H5Pset_fclose_degree(properties.get(), H5F_CLOSE_STRONG);
  H5Pset_file_locking(properties.get(), false, true);
  return properties;
}

}  // namespace

Handle::Handle(Handle&& other) noexcept
    : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(std::exchange(other.close_, nullptr)) {}

Handle& Handle::operator=(Handle&& other) noexcept {
  if (this != &other) {
    close();
    id_ = std::exchange(other.id_, H5I_INVALID_HID);
    close_ = std::exchange(other.close_, nullptr);
  }
  return *this;
}

bool Handle::close() {
  if (id_ < 0 || close_ == nullptr) return true;
  return close_(std::exchange(id_, H5I_INVALID_HID)) >= 0;
}

void Object::fail(std::string_view problem) const { fail_on(*origin_, path_, problem); }

Handle Object::own(hid_t id, Handle::Close close, std::string_view problem) const {
  if (id < 0) fail(problem);
  return Handle(id, close);
}

void Object::require(herr_t status, std::string_view problem) const {
  if (status < 0) fail(problem);
}

bool Object::has_attribute(const std::string& name) const { return H5Aexists(id(), name.c_str()) > 0; }

std::vector<std::string> Object::attribute_names() const {
  std::vector<std::string> names;
  const auto visit = [](hid_t, const char* name, const H5A_info_t*, void* found) -> herr_t {
    static_cast<std::vector<std::string>*>(found)->emplace_back(name);
    return 0;
  };
  hsize_t position = 0;
  require(H5Aiterate2(id(), H5_INDEX_CRT_ORDER, H5_ITER_INC, &position, visit, &names), "its list of attributes");
  return names;
}

void Object::write_attribute(const std::string& name, hid_t type, hid_t from, hid_t space, const void* data) {
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
  const hsize_t size = values.size();
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
  const std::string value = data == nullptr ? "" : data;
  H5free_memory(data);
  return value;
}

std::int64_t Object::integer(const std::string& name) const {
  const Handle attribute = open_attribute(name);
  std::int64_t value = 0;
  require(H5Aread(attribute.get(), H5T_NATIVE_INT64, &value), fmt::format("the attribute '{}' is not a number", name));
  return value;
}

std::uint64_t Object::unsigned_integer(const std::string& name) const {
  const Handle attribute = open_attribute(name);
  std::uint64_t value = 0;
  require(H5Aread(attribute.get(), H5T_NATIVE_UINT64, &value),
          fmt::format("the attribute '{}' is not a number", name));
  return value;
}

Dataset::Dataset(Handle handle, std::shared_ptr<const Origin> origin, std::string path)
    : Object(std::move(handle), std::move(origin), std::move(path)), element_(stored_element()) {}

Element Dataset::stored_element() const {
  const Handle type = own(H5Dget_type(id()), H5Tclose, "its type cannot be read");
  if (H5Tis_variable_str(type.get()) > 0) return Element::text;
  for (const Element element : {Element::float64, Element::int64, Element::int32, Element::int8, Element::flag}) {
    if (H5Tequal(type.get(), file_type(element)) > 0) return element;
  }
  fail("its elements have an unexpected type");
}

std::vector<hsize_t> Dataset::extent() const {
  const Handle space = own(H5Dget_space(id()), H5Sclose, "its size cannot be read");
  std::vector<hsize_t> extent(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.get()))));
  H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr);
  return extent;
}

Dataset::Selection Dataset::select(std::int64_t first, std::int64_t rows) const {
  std::vector<hsize_t> count = extent();
  if (count.empty() || first < 0 || rows < 0 || static_cast<hsize_t>(first + rows) > count[0]) {
    fail(fmt::format("it has {} rows; rows {} to {} were expected", count.empty() ? 0 : count[0], first, first + rows));
  }
  count[0] = static_cast<hsize_t>(rows);
  std::vector<hsize_t> start(count.size(), 0);
  start[0] = static_cast<hsize_t>(first);
  Selection selection{own(H5Dget_space(id()), H5Sclose, "its size cannot be read"),
                      Handle(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose)};
  require(H5Sselect_hyperslab(selection.file.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
          "its rows cannot be selected");
  return selection;
}

void Dataset::write(std::int64_t first, std::int64_t rows, const void* data) {
  const Selection selection = select(first, rows);
  require(H5Dwrite(id(), memory_type(element_), selection.memory.get(), selection.file.get(), H5P_DEFAULT, data),
          "its values");
}

void Dataset::read(std::int64_t first, std::int64_t rows, void* data) const {
  const Selection selection = select(first, rows);
  require(H5Dread(id(), memory_type(element_), selection.memory.get(), selection.file.get(), H5P_DEFAULT, data),
          "its values cannot be read or their checksum is wrong");
}

void Dataset::write_texts(std::span<const std::string> texts) {
  if (texts.empty()) return;
  std::vector<const char*> data(texts.size());
  std::transform(texts.begin(), texts.end(), data.begin(), [](const std::string& text) { return text.c_str(); });
  require(H5Dwrite(id(), text_type().get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()), "its texts");
}

std::vector<std::string> Dataset::read_texts() const {
  if (element_ != Element::text) fail("its elements are not texts");
  const Handle space = own(H5Dget_space(id()), H5Sclose, "its size cannot be read");
  std::vector<char*> data(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())), nullptr);
  if (data.empty()) return {};
  const Handle type = text_type();
  require(H5Dread(id(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()),
          "its texts cannot be read or their checksum is wrong");
  std::vector<std::string> texts(data.size());
  std::transform(data.begin(), data.end(), texts.begin(), [](const char* text) { return text == nullptr ? "" : text; });
  H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, data.data());
  return texts;
}

bool Dataset::has_all_chunks() const {
  const std::vector<hsize_t> rows = extent();
  const Handle properties(H5Dget_create_plist(id()), H5Pclose);
  if (H5Pget_layout(properties.get()) != H5D_CHUNKED) return true;
  std::vector<hsize_t> chunk(rows.size(), 1);
  if (H5Pget_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()) < 0) return false;
  hsize_t expected = 1;
  for (std::size_t dimension = 0; dimension < rows.size(); ++dimension) {
    expected *= (rows[dimension] + chunk[dimension] - 1) / chunk[dimension];
  }
  hsize_t present = 0;
  const Handle space(H5Dget_space(id()), H5Sclose);
  return H5Dget_num_chunks(id(), space.get(), &present) >= 0 && present == expected;
}

void Dataset::make_scale(const std::string& name) { require(H5DSset_scale(id(), name.c_str()), "its name as an axis"); }

void Dataset::attach_scale(const Dataset& scale, unsigned dimension) {
  require(H5DSattach_scale(id(), scale.id(), dimension), "its axis");
}

std::string Group::path_to(const std::string& name) const { return path() == "/" ? "/" + name : path() + "/" + name; }

Group Group::create_group(const std::string& name) {
  const Handle properties = creation_properties(H5P_GROUP_CREATE);
  return Group(own(H5Gcreate2(id(), name.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Gclose,
                   fmt::format("the group '{}'", name)),
               origin(), path_to(name));
}

Group Group::open_group(const std::string& name) const {
  return Group(own(H5Gopen2(id(), name.c_str(), H5P_DEFAULT), H5Gclose, fmt::format("the group '{}' is missing", name)),
               origin(), path_to(name));
}

Dataset Group::create_dataset(const std::string& name, const Storage& storage) {
  const std::string problem = fmt::format("the dataset '{}'", name);
  const Handle properties = creation_properties(H5P_DATASET_CREATE);
  Handle space;
  if (storage.extent.empty()) {
    space = own(H5Screate(H5S_SCALAR), H5Sclose, problem);
  } else {
    const int rank = static_cast<int>(storage.extent.size());
    std::vector<hsize_t> limit = storage.extent;
    if (storage.extendible) limit[0] = H5S_UNLIMITED;
    space = own(H5Screate_simple(rank, storage.extent.data(), limit.data()), H5Sclose, problem);
    require(H5Pset_chunk(properties.get(), rank, storage.chunk.data()), problem);
    if (storage.element != Element::text) {  // the library has no filters for variable-length elements
      require(H5Pset_shuffle(properties.get()), problem);
      require(H5Pset_deflate(properties.get(), deflate_level), problem);
      require(H5Pset_fletcher32(properties.get()), problem);
    }
  }
  const Handle text = text_type();
  const hid_t type = storage.element == Element::text ? text.get() : file_type(storage.element);
  return Dataset(own(H5Dcreate2(id(), name.c_str(), type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                     H5Dclose, problem),
                 origin(), path_to(name));
}

Dataset Group::open_dataset(const std::string& name) const {
  return Dataset(
      own(H5Dopen2(id(), name.c_str(), H5P_DEFAULT), H5Dclose, fmt::format("the dataset '{}' is missing", name)),
      origin(), path_to(name));
}

bool Group::contains(const std::string& name) const { return H5Lexists(id(), name.c_str(), H5P_DEFAULT) > 0; }

bool Group::is_group(const std::string& name) const {
  H5O_info_t info{};
  require(H5Oget_info_by_name2(id(), name.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT),
          fmt::format("its member '{}' cannot be read", name));
  return info.type == H5O_TYPE_GROUP;
}

std::vector<std::string> Group::children() const {
  std::vector<std::string> names;
  const auto visit = [](hid_t, const char* name, const H5L_info_t*, void* found) -> herr_t {
    static_cast<std::vector<std::string>*>(found)->emplace_back(name);
    return 0;
  };
  hsize_t position = 0;
  require(H5Literate(id(), H5_INDEX_CRT_ORDER, H5_ITER_INC, &position, visit, &names), "its list of members");
  return names;
}

bool is_hdf5(const std::filesystem::path& path) {
  quieten();
  return H5Fis_hdf5(path.c_str()) > 0;
}

File File::wrap(hid_t file, std::shared_ptr<const Origin> origin) {
  if (file < 0) fail_on(*origin, "the file", "it is cut short or its structure is broken");
  Handle handle(file, H5Fclose);
  const hid_t root = H5Gopen2(file, "/", H5P_DEFAULT);
  if (root < 0) fail_on(*origin, "/", "the root group cannot be opened");
  return File(std::move(handle), Handle(root, H5Gclose), std::move(origin));
}

File File::create(const std::filesystem::path& path) {
  quieten();
  const Handle creation = creation_properties(H5P_FILE_CREATE);
  const Handle access = access_properties();
  return wrap(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()),
              std::make_shared<Origin>(Origin{path.string(), true}));
}

File File::open_to_read(const std::filesystem::path& path) {
  quieten();
  const Handle access = access_properties();
  return wrap(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()),
              std::make_shared<Origin>(Origin{path.string(), false}));
}

File File::open_to_change(const std::filesystem::path& path) {
  quieten();
  const Handle access = access_properties();
  return wrap(H5Fopen(path.c_str(), H5F_ACC_RDWR, access.get()),
              std::make_shared<Origin>(Origin{path.string(), true}));
}

void File::close() {
  handle_.close();
  if (!file_.close()) fail("the rest of its contents");
}

}  // namespace zerocount::hdf5
