#include "tests/support/raw_hdf5.hpp"

#include <hdf5.h>

#include "results/storage/file_contents.hpp"
#include "tests/support/checksum.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

hid_t checked(hid_t id) {
  if (id < 0) throw std::runtime_error("the HDF5 library refuses");
  return id;
}

hid_t open_file(const std::filesystem::path& path, unsigned flags) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);  // this and the next as in files that a test has open
  H5Pset_file_locking(access, false, true);
  const hid_t file = H5Fopen(path.c_str(), flags, access);
  H5Pclose(access);
  return checked(file);
}

std::string describe(hid_t dataset, hid_t type) {
  const hid_t space = H5Dget_space(dataset);
  std::string text = "rank " + std::to_string(H5Sget_simple_extent_ndims(space));
  text += " size " + std::to_string(H5Sget_simple_extent_npoints(space));
  text += " class " + std::to_string(H5Tget_class(type)) + " bytes " + std::to_string(H5Tget_size(type));
  const hid_t properties = H5Dget_create_plist(dataset);
  text += " filters " + std::to_string(H5Pget_nfilters(properties)) + "\n";
  H5Pclose(properties);
  H5Sclose(space);
  return text;
}

std::string texts_of(hid_t dataset, hid_t type) {
  const hid_t space = H5Dget_space(dataset);
  std::vector<char*> texts(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)), nullptr);
  std::string joined;
  if (!texts.empty()) {
    H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data());
    for (const char* text : texts) joined += std::string(text == nullptr ? "" : text) + "\n";
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, texts.data());
  }
  H5Sclose(space);
  return joined;
}

std::string chunks_of(hid_t dataset) {
  const hid_t space = H5Dget_space(dataset);
  hsize_t chunks = 0;
  H5Dget_num_chunks(dataset, space, &chunks);
  std::string bytes;
  for (hsize_t chunk = 0; chunk < chunks; ++chunk) {
    std::array<hsize_t, H5S_MAX_RANK> offset{};
    hsize_t size = 0;
    std::uint32_t mask = 0;
    checked(H5Dget_chunk_info(dataset, space, chunk, offset.data(), &mask, nullptr, &size));
    std::string content(size, '\0');
    checked(H5Dread_chunk(dataset, H5P_DEFAULT, offset.data(), &mask, content.data()));
    for (const hsize_t place : offset) bytes += std::to_string(place) + ",";
    bytes += ":" + content;
  }
  H5Sclose(space);
  return bytes;
}

herr_t visit(hid_t file, const char* name, const H5O_info_t* info, void* found) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  const hid_t dataset = checked(H5Dopen2(file, name, H5P_DEFAULT));
  const hid_t type = H5Dget_type(dataset);
  (*static_cast<std::map<std::string, std::string>*>(found))[std::string("/") + name] =
      describe(dataset, type) + (H5Tis_variable_str(type) > 0 ? texts_of(dataset, type) : chunks_of(dataset));
  H5Tclose(type);
  H5Dclose(dataset);
  return 0;
}

herr_t visit_numbers(hid_t file, const char* name, const H5O_info_t* info, void* found) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  const hid_t dataset = checked(H5Dopen2(file, name, H5P_DEFAULT));
  const hid_t type = H5Dget_type(dataset);
  const hid_t space = H5Dget_space(dataset);
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  if (H5Tget_class(type) == H5T_INTEGER || H5Tget_class(type) == H5T_FLOAT)
    (*static_cast<std::map<std::string, std::size_t>*>(found))[std::string("/") + name] =
        static_cast<std::size_t>(size);
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(dataset);
  return 0;
}

/// Flips the last bit of an element's bytes; a NaN (if `real`) becomes 0.5.
void change_bytes(char* element, std::size_t size, bool real) {
  double number = 0.0;
  if (real) std::memcpy(&number, element, sizeof number);
  if (!std::isnan(number)) {
    element[0] = static_cast<char>(element[0] ^ 1);
    return;
  }
  number = 0.5;
  std::memcpy(element, &number, size);
}

void replace(const std::filesystem::path& path, const std::string& name, hid_t type, const void* value) {
  remove_checksum(path);
  const hid_t file = open_file(path, H5F_ACC_RDWR);
  H5Adelete(file, name.c_str());
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = checked(H5Acreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT));
  H5Awrite(attribute, type, value);
  H5Sclose(space);
  H5Fclose(file);
  append_checksum(path);
}

}  // namespace

void replace_by_texts(const std::filesystem::path& path, const std::string& dataset, std::uint64_t rows) {
  remove_checksum(path);
  const hid_t file = open_file(path, H5F_ACC_RDWR);
  H5Ldelete(file, dataset.c_str(), H5P_DEFAULT);
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  const hsize_t extent = rows, limit = H5S_UNLIMITED, chunk = 16;
  const hid_t space = H5Screate_simple(1, &extent, &limit);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(properties, 1, &chunk);
  checked(H5Dcreate2(file, dataset.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  H5Pclose(properties);
  H5Sclose(space);
  H5Tclose(type);
  H5Fclose(file);
  append_checksum(path);
}

std::map<std::string, std::string> stored_datasets(const std::filesystem::path& path) {
  const hid_t file = open_file(path, H5F_ACC_RDONLY);
  std::map<std::string, std::string> datasets;
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit, &datasets, H5O_INFO_BASIC);
  H5Fclose(file);
  return datasets;
}

void expect_same_datasets(const std::filesystem::path& one, const std::filesystem::path& other) {
  const auto left = stored_datasets(one);
  const auto right = stored_datasets(other);
  ASSERT_EQ(left.size(), right.size());
  for (const auto& [path, bytes] : left) {
    const auto same = right.find(path);
    EXPECT_TRUE(same != right.end() && same->second == bytes) << path;
  }
}

std::optional<std::string> elements_of(const std::filesystem::path& path, const std::string& name) {
  const hid_t file = open_file(path, H5F_ACC_RDONLY);
  const hid_t dataset = checked(H5Dopen2(file, name.c_str(), H5P_DEFAULT));
  const hid_t space = H5Dget_space(dataset);
  const hid_t type = H5Dget_type(dataset);
  std::string elements(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)) * H5Tget_size(type),
                       '\0');
  const bool readable = H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, elements.data()) >= 0;
  H5Tclose(type);
  H5Sclose(space);
  H5Fclose(file);
  return readable ? std::optional(elements) : std::nullopt;
}

std::map<std::string, std::size_t> sizes_of_numbers(const std::filesystem::path& path) {
  const hid_t file = open_file(path, H5F_ACC_RDONLY);
  std::map<std::string, std::size_t> sizes;
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit_numbers, &sizes, H5O_INFO_BASIC);
  H5Fclose(file);
  return sizes;
}

namespace {

/// Rewrites the element `index` of the dataset `name`. `change` gets the bytes of the element, their number
/// and whether it is a floating-point number.
void rewrite_element(const std::filesystem::path& path, const std::string& name, std::size_t index,
                     const std::function<void(char*, std::size_t, bool)>& change) {
  std::string elements = elements_of(path, name).value();
  remove_checksum(path);
  const hid_t file = open_file(path, H5F_ACC_RDWR);
  const hid_t dataset = checked(H5Dopen2(file, name.c_str(), H5P_DEFAULT));
  const hid_t type = H5Dget_type(dataset);
  const std::size_t size = H5Tget_size(type);
  change(elements.data() + index * size, size, H5Tget_class(type) == H5T_FLOAT);
  checked(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, elements.data()));
  H5Tclose(type);
  H5Dclose(dataset);
  H5Fclose(file);
  append_checksum(path);
}

}  // namespace

void change_element(const std::filesystem::path& path, const std::string& name, std::size_t index) {
  rewrite_element(path, name, index, change_bytes);
}

void set_element(const std::filesystem::path& path, const std::string& name, std::size_t index,
                 double value) {
  rewrite_element(path, name, index, [&](char* bytes, std::size_t size, bool real) {
    if (!real || size != sizeof value) throw std::invalid_argument(name + " has no doubles");
    std::memcpy(bytes, &value, size);
  });
}

std::set<std::string> attribute_names(const std::filesystem::path& path) {
  const hid_t file = open_file(path, H5F_ACC_RDONLY);
  std::set<std::string> names;
  const auto visit_name = [](hid_t, const char* name, const H5A_info_t*, void* found) -> herr_t {
    static_cast<std::set<std::string>*>(found)->insert(name);
    return 0;
  };
  H5Aiterate2(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit_name, &names);
  H5Fclose(file);
  return names;
}

void replace_attribute(const std::filesystem::path& path, const std::string& name, std::int64_t value) {
  replace(path, name, H5T_NATIVE_INT64, &value);
}

void replace_attribute(const std::filesystem::path& path, const std::string& name, const std::string& value) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);  // as in all files: the library does not always convert to it from ASCII
  const char* text = value.c_str();
  replace(path, name, type, &text);
  H5Tclose(type);
}

void remove_attribute(const std::filesystem::path& path, const std::string& name) {
  remove_checksum(path);
  const hid_t file = open_file(path, H5F_ACC_RDWR);
  H5Adelete(file, name.c_str());
  H5Fclose(file);
  append_checksum(path);
}

void write_empty_hdf5(const std::filesystem::path& path) {
  H5Fclose(checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)));
}

void remove_checksum(const std::filesystem::path& path) {
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - storage::checksum_trailer_length);
}

std::uint64_t chunk_address(const std::filesystem::path& path, const std::string& name) {
  const hid_t file = open_file(path, H5F_ACC_RDONLY);
  const hid_t dataset = checked(H5Dopen2(file, name.c_str(), H5P_DEFAULT));
  const hid_t space = H5Dget_space(dataset);
  hsize_t offset[2] = {0, 0};
  std::uint32_t mask = 0;
  haddr_t address = 0;
  hsize_t size = 0;
  H5Dget_chunk_info(dataset, space, 0, offset, &mask, &address, &size);
  H5Sclose(space);
  H5Fclose(file);
  return address;
}

}  // namespace zerocount::testing
