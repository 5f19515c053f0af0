#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "results/hdf5/foreign_file.hpp"
#include "results/hdf5/hdf5_detail.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_contents.hpp"

namespace zerocount::hdf5 {
namespace {

bool is_number_type(Id dataset) {
  const Handle type(H5Dget_type(dataset), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type.get());
  return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

}  // namespace

bool is_hdf5_with_user_block(const std::filesystem::path& path) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  constexpr std::array<std::size_t, 5> places{0, 512, 1024, 2048, 4096};  // those of the library
  return std::any_of(places.begin(), places.end(), [&](std::size_t place) {
    return storage::bytes_at(path, place, signature.size()) == signature;
  });
}

Handle ArrayFile::open(const std::string& path) const {
  Handle dataset(H5Dopen2(id(), path.c_str(), H5P_DEFAULT), H5Dclose);
  return dataset.get() >= 0 && is_number_type(dataset.get()) ? std::move(dataset) : Handle();
}

std::vector<std::string> ArrayFile::arrays() const {
  std::vector<std::string> found;
  const auto visit = [](Id, const char* name, const H5O_info_t* info, void* all) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(all)->emplace_back(name);
    return 0;
  };
  require(H5Ovisit2(id(), H5_INDEX_NAME, H5_ITER_INC, visit, &found, H5O_INFO_BASIC), "its list of members");
  std::erase_if(found, [&](const std::string& name) { return open(name).get() < 0; });
  for (std::string& name : found) name.insert(0, "/");
  return found;
}

std::optional<std::vector<Size>> ArrayFile::lengths(const std::string& path) const {
  const Handle dataset = open(path);
  if (dataset.get() < 0) return std::nullopt;
  const Handle space = own(H5Dget_space(dataset.get()), H5Sclose, "the size of an array cannot be read");
  const int rank = H5Sget_simple_extent_ndims(space.get());
  require(rank, "the size of an array cannot be read");
  std::vector<Size> lengths(static_cast<std::size_t>(rank));
  require(H5Sget_simple_extent_dims(space.get(), lengths.data(), nullptr),
          "the size of an array cannot be read");
  return lengths;
}

std::vector<double> ArrayFile::values(const std::string& path) const {
  const Handle dataset = open(path);
  const Handle space = own(H5Dget_space(dataset.get()), H5Sclose, "the size of an array cannot be read");
  const hssize_t size = H5Sget_simple_extent_npoints(space.get());
  require(size < 0 ? -1 : 0, "the size of an array cannot be read");
  std::vector<double> values(static_cast<std::size_t>(size));
  const herr_t status =
      H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  if (status < 0) require_known_filters(dataset.get(), file_name(), path);
  require(status, path + ": " + std::string(unreadable_values));
  return values;
}

}  // namespace zerocount::hdf5
