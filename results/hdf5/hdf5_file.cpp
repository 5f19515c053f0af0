#include <utility>

#include <fmt/format.h>

#include "results/hdf5/hdf5_detail.hpp"

namespace zerocount::hdf5 {
namespace {

/// Level of deflate: the inputs of trials are random digits, which higher levels only spend time on.
constexpr unsigned deflate_level = 1;

/// No text of the library on stderr, and no work of its own at exit, where it would retry writes that have
/// failed.
void quieten() {
  static const herr_t no_work_at_exit = H5dont_atexit();
  static_cast<void>(no_work_at_exit);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // a setting of the calling thread
}

/// Object headers of version 2 carry checksums; later formats would lock out readers built on HDF5 1.8. Files
/// are immutable once they have their name, so the library's own file locks (which fail on some cluster file
/// systems) are off.
Handle access_properties() {
  Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(properties.get(), H5F_LIBVER_V18, H5F_LIBVER_V18);
  H5Pset_fclose_degree(properties.get(), H5F_CLOSE_STRONG);
  H5Pset_file_locking(properties.get(), false, true);
  return properties;
}

}  // namespace

std::string Group::path_to(const std::string& name) const {
  return path() == "/" ? "/" + name : path() + "/" + name;
}

Group Group::create_group(const std::string& name) {
  const Handle properties = creation_properties(H5P_GROUP_CREATE);
  return Group(own(H5Gcreate2(id(), name.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Gclose,
                   fmt::format("the group '{}'", name)),
               origin(), path_to(name));
}

Group Group::open_group(const std::string& name) const {
  return Group(own(H5Gopen2(id(), name.c_str(), H5P_DEFAULT), H5Gclose,
                   fmt::format("the group '{}' is missing", name)),
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
    std::vector<Size> limit = storage.extent;
    if (storage.extendible) limit[0] = H5S_UNLIMITED;
    space = own(H5Screate_simple(rank, storage.extent.data(), limit.data()), H5Sclose, problem);
    require(H5Pset_chunk(properties.get(), rank, storage.chunk.data()), problem);
    if (storage.element != Element::text) {  // the library has no filters for variable-length elements
      if (storage.compression == Compression::deflate) {
        require(H5Pset_shuffle(properties.get()), problem);
        require(H5Pset_deflate(properties.get(), deflate_level), problem);
      }
      require(H5Pset_fletcher32(properties.get()), problem);
    }
  }
  const Handle text = text_type();
  const Id type = storage.element == Element::text ? text.get() : file_type(storage.element);
  return Dataset(
      own(H5Dcreate2(id(), name.c_str(), type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
          H5Dclose, problem),
      origin(), path_to(name));
}

Dataset Group::open_dataset(const std::string& name) const {
  return Dataset(own(H5Dopen2(id(), name.c_str(), H5P_DEFAULT), H5Dclose,
                     fmt::format("the dataset '{}' is missing", name)),
                 origin(), path_to(name));
}

bool Group::contains(const std::string& name) const {
  return H5Lexists(id(), name.c_str(), H5P_DEFAULT) > 0;
}

bool Group::is_group(const std::string& name) const {
  H5O_info_t info;
  require(H5Oget_info_by_name2(id(), name.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT), "a member of it");
  return info.type == H5O_TYPE_GROUP;
}

std::vector<std::string> Group::children() const {
  std::vector<std::string> names;
  const auto visit = [](Id, const char* name, const H5L_info_t*, void* found) -> herr_t {
    static_cast<std::vector<std::string>*>(found)->emplace_back(name);
    return 0;
  };
  Size position = 0;
  require(H5Literate(id(), H5_INDEX_CRT_ORDER, H5_ITER_INC, &position, visit, &names), "its list of members");
  return names;
}

bool is_hdf5(const std::filesystem::path& path) {
  quieten();
  const htri_t answer = H5Fis_hdf5(path.c_str());
  if (answer < 0) fail_on({path.string(), false}, "/", "its beginning cannot be read");
  return answer > 0;
}

File File::wrap(Id file, std::shared_ptr<const Origin> origin) {
  if (file < 0) fail_on(*origin, "/", "it is cut short or its structure is broken");
  Handle handle(file, H5Fclose);
  const Id root = H5Gopen2(file, "/", H5P_DEFAULT);
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
