#include "tests/fuzz/hdf5_edits.hpp"

#include <array>
#include <vector>

#include <hdf5.h>

namespace zerocount::fuzz {
namespace {

/// Owner of an identifier of the HDF5 library. It may be invalid; the library then refuses it.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }  // NOLINT: used as the library's own

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

Id text_type() {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return {type, H5Tclose};
}

Id open_object(hid_t file, const std::string& path) {
  return {H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose};
}

void set_attribute(hid_t file, const AttributePlace& attribute, hid_t type, const void* value) {
  const Id object = open_object(file, attribute.object);
  if (object < 0) return;
  H5Adelete(object, attribute.name.c_str());
  const Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const Id made(H5Acreate2(object, attribute.name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (made >= 0) H5Awrite(made, type, value);
}

/// Writes one element of a dataset.
/// @param type HDF5 type of the value in memory
/// @param place index of the element
void write_element(hid_t dataset, hid_t type, std::uint64_t place, const void* value) {
  const Id space(H5Dget_space(dataset), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  std::array<hsize_t, H5S_MAX_RANK> extent{}, at{};
  if (rank < 0 || H5Sget_simple_extent_npoints(space) <= 0) return;
  H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  for (int i = rank - 1; i >= 0; --i) {
    const auto axis = static_cast<std::size_t>(i);
    at[axis] = place % extent[axis];
    place /= extent[axis];
  }
  if (rank > 0) H5Sselect_elements(space, H5S_SELECT_SET, 1, at.data());
  const Id single(H5Screate(H5S_SCALAR), H5Sclose);
  H5Dwrite(dataset, type, single, space, H5P_DEFAULT, value);
}

bool is_text(hid_t dataset) {
  const Id type(H5Dget_type(dataset), H5Tclose);
  return H5Tget_class(type) == H5T_STRING;
}

Id open_dataset(hid_t file, const std::string& path) {
  return {H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose};
}

void copy_attributes(hid_t from, hid_t to) {
  const auto copy = [](hid_t object, const char* name, const H5A_info_t*, void* target) -> herr_t {
    const Id source(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    const Id type(H5Aget_type(source), H5Tclose);
    const Id space(H5Aget_space(source), H5Sclose);
    if (H5Tis_variable_str(type) <= 0) return 0;
    char* text = nullptr;
    if (H5Aread(source, type, &text) < 0) return 0;
    const Id made(H5Acreate2(*static_cast<hid_t*>(target), name, type, space, H5P_DEFAULT, H5P_DEFAULT),
                  H5Aclose);
    if (made >= 0) H5Awrite(made, type, &text);
    H5free_memory(text);
    return 0;
  };
  H5Aiterate2(from, H5_INDEX_NAME, H5_ITER_INC, nullptr, copy, &to);
}

}  // namespace

EditedHdf5::EditedHdf5(const std::filesystem::path& path) : file_(-1) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  file_ = H5Fopen(path.c_str(), H5F_ACC_RDWR, access);
}

EditedHdf5::~EditedHdf5() {
  if (file_ >= 0) H5Fclose(file_);
}

void EditedHdf5::set_integer(const AttributePlace& attribute, std::int64_t value) const {
  set_attribute(file_, attribute, H5T_NATIVE_INT64, &value);
}

void EditedHdf5::set_text(const AttributePlace& attribute, const std::string& value) const {
  const Id type = text_type();
  const char* const text = value.c_str();
  set_attribute(file_, attribute, type, &text);
}

void EditedHdf5::remove(const AttributePlace& attribute) const {
  const Id object = open_object(file_, attribute.object);
  H5Adelete(object, attribute.name.c_str());
}

void EditedHdf5::set_element(const std::string& dataset, std::uint64_t place, std::uint64_t bits) const {
  const Id opened = open_dataset(file_, dataset);
  if (opened < 0 || is_text(opened)) return;
  const Id type(H5Dget_type(opened), H5Tclose);
  const bool real = H5Tget_class(type) == H5T_FLOAT;
  write_element(opened, real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64, place, &bits);
}

void EditedHdf5::set_element(const std::string& dataset, std::uint64_t place, const std::string& text) const {
  const Id opened = open_dataset(file_, dataset);
  if (opened < 0 || !is_text(opened)) return;
  const Id type = text_type();
  const char* const pointer = text.c_str();
  write_element(opened, type, place, &pointer);
}

void EditedHdf5::resize(const std::string& dataset, std::uint64_t rows) const {
  const Id opened = open_dataset(file_, dataset);
  const Id space(H5Dget_space(opened), H5Sclose);
  std::array<hsize_t, H5S_MAX_RANK> extent{};
  if (H5Sget_simple_extent_ndims(space) < 1) return;
  H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  extent[0] = rows;
  H5Dset_extent(opened, extent.data());
}

void EditedHdf5::remove(const std::string& path) const {
  H5Ldelete(file_, path.c_str(), H5P_DEFAULT);
}

void EditedHdf5::rename(const std::string& path, const std::string& other) const {
  H5Lmove(file_, path.c_str(), file_, other.c_str(), H5P_DEFAULT, H5P_DEFAULT);
}

void EditedHdf5::replace_by_group(const std::string& path) const {
  remove(path);
  const Id made(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
}

void EditedHdf5::replace_by_dataset(const std::string& path, std::uint8_t type, unsigned rank,
                                    std::uint64_t size) const {
  const Id text = text_type();
  const std::array<hid_t, 7> types{H5T_STD_I8LE,   H5T_STD_I64LE, H5T_STD_U64LE, H5T_IEEE_F64LE,
                                   H5T_IEEE_F32LE, H5T_STD_I32LE, text};
  const std::array<hsize_t, 3> extent{size, 2, 2}, limit{H5S_UNLIMITED, 2, 2}, chunk{16, 2, 2};
  const Id before = open_object(file_, path);
  if (before < 0) return;
  remove(path);
  const Id space(rank == 0 ? H5Screate(H5S_SCALAR)
                           : H5Screate_simple(static_cast<int>(rank), extent.data(), limit.data()),
                 H5Sclose);
  const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (rank > 0) H5Pset_chunk(properties, static_cast<int>(rank), chunk.data());
  const Id made(H5Dcreate2(file_, path.c_str(), types[type % types.size()], space, H5P_DEFAULT, properties,
                           H5P_DEFAULT),
                H5Dclose);
  if (made >= 0) copy_attributes(before, made);
}

void EditedHdf5::list(SampleFile& sample) const {
  const auto visit = [](hid_t file, const char* name, const H5O_info_t*, void* found) -> herr_t {
    static_cast<std::vector<std::string>*>(found)->push_back(name);
    static_cast<void>(file);
    return 0;
  };
  H5Ovisit2(file_, H5_INDEX_NAME, H5_ITER_INC, visit, &sample.objects, H5O_INFO_BASIC);
  for (const std::string& path : sample.objects) {
    const Id object = open_object(file_, path);
    std::vector<std::string> names;
    const auto add = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
      static_cast<std::vector<std::string>*>(list)->push_back(name);
      return 0;
    };
    H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names);
    for (const std::string& name : names) sample.attributes.push_back({path, name});
  }
}

}  // namespace zerocount::fuzz
