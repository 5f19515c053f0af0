#include <algorithm>
#include <memory>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <hdf5.h>

#include "results/hdf5/file_driver.hpp"
#include "results/hdf5/hdf5_detail.hpp"

namespace zerocount::hdf5 {
namespace {

using Mode = storage::ByteFile::Mode;

std::shared_ptr<Origin> origin_of(const std::filesystem::path& path, Mode mode,
                                  storage::WrittenBytes so_far = {}) {
  return std::make_shared<Origin>(
      Origin{std::make_shared<storage::ByteFile>(path, mode, std::move(so_far)), false});
}

/// Whether a file of `bytes` bytes can hold all elements that the dataset claims to have. A reader that
/// trusts a larger size runs out of memory.
bool fits(const Dataset& dataset, std::uint64_t bytes) {
  constexpr Size max_ratio = 1100;     // deflate makes at most 1032 bytes of one
  constexpr Size text_reference = 16;  // of a text, which is elsewhere in the file
  const bool is_text = dataset.element() == Element::text;
  Size room = bytes * max_ratio / (is_text ? text_reference : size_of(dataset.element()));
  for (const Size length : dataset.extent()) {
    if (length > room) return false;
    room /= std::max<Size>(length, 1);
  }
  return true;
}

}  // namespace

std::string Group::path_to(const std::string& name) const {
  return path() == "/" ? "/" + name : path() + "/" + name;
}

Group Group::create_group(const std::string& name) {
  const LibraryUse use;
  const Handle properties = creation_properties(H5P_GROUP_CREATE);
  return Group(own(H5Gcreate2(id(), name.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Gclose,
                   fmt::format("the group '{}'", name)),
               origin(), path_to(name));
}

Group Group::open_group(const std::string& name) const {
  const LibraryUse use;
  return Group(own(H5Gopen2(id(), name.c_str(), H5P_DEFAULT), H5Gclose,
                   fmt::format("the group '{}' is missing", name)),
               origin(), path_to(name));
}

Dataset Group::create_dataset(const std::string& name, const Storage& storage) {
  const LibraryUse use;
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
    if (storage.element != Element::text) {  // filters do not apply to variable-length elements
      if (storage.compression == Compression::deflate) {
        require(H5Pset_shuffle(properties.get()), problem);
        require(H5Pset_deflate(properties.get(), deflate_level), problem);
      }
      require(H5Pset_fletcher32(properties.get()), problem);
    }
  }
  const Handle text = text_type();
  const Id type = storage.element == Element::text ? text.get() : types_of(storage.element).file;
  return Dataset(
      own(H5Dcreate2(id(), name.c_str(), type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
          H5Dclose, problem),
      origin(), path_to(name));
}

Dataset Group::open_dataset(const std::string& name) const {
  const LibraryUse use;
  Dataset dataset(own(H5Dopen2(id(), name.c_str(), H5P_DEFAULT), H5Dclose,
                      fmt::format("the dataset '{}' is missing", name)),
                  origin(), path_to(name));
  if (!origin()->bytes->writable() && !fits(dataset, origin()->bytes->size()))
    dataset.fail("its size is more than the file can hold");
  return dataset;
}

bool Group::contains(const std::string& name) const {
  const LibraryUse use;
  if (name.empty() || name == "." || name.find('/') != std::string::npos) return false;  // paths, not names
  const htri_t answer = H5Lexists(id(), name.c_str(), H5P_DEFAULT);
  require(answer, "its list of members");
  return answer > 0;
}

bool Group::is_group(const std::string& name) const {
  const LibraryUse use;
  H5O_info_t info;
  require(H5Oget_info_by_name2(id(), name.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT), "a member of it");
  return info.type == H5O_TYPE_GROUP;
}

std::vector<std::string> Group::children() const {
  const LibraryUse use;
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
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  const std::shared_ptr<Origin> origin = origin_of(path, Mode::read);
  std::string beginning(signature.size(), '\0');
  if (!origin->bytes->read(0, std::as_writable_bytes(std::span(beginning)))) fail_on(*origin, "/", "");
  return beginning == signature;
}

File File::open(std::shared_ptr<Origin> origin, bool create) {
  const LibraryUse use;
  const std::string path = origin->bytes->path().string();
  const Handle creation = creation_properties(H5P_FILE_CREATE);
  const Handle access = access_properties(origin->bytes);
  const unsigned flags = origin->bytes->writable() ? H5F_ACC_RDWR : H5F_ACC_RDONLY;
  Handle file(create ? H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get())
                     : H5Fopen(path.c_str(), flags, access.get()),
              H5Fclose);
  if (file.get() < 0) fail_on(*origin, "/", "it is cut short or its structure is broken");
  Handle root(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose);
  File opened(std::move(file), std::move(root), std::move(origin));
  opened.require(static_cast<herr_t>(opened.id() < 0 ? -1 : 0), "the root group cannot be opened");
  return opened;
}

File File::create(const std::filesystem::path& path) {
  return open(origin_of(path, Mode::create), true);
}

File File::open_to_read(const std::filesystem::path& path) {
  return open(origin_of(path, Mode::read), false);
}

File File::open_to_change(const std::filesystem::path& path, storage::WrittenBytes so_far) {
  return open(origin_of(path, Mode::change, std::move(so_far)), false);
}

File::~File() {
  release();  // the root, before its file
  if (origin() && origin()->broken()) {
    file_.abandon();
    origin()->bytes->close();  // an open file would keep its disk space after its removal
  }
}

storage::WrittenBytes File::close(storage::Flush flush) {
  const LibraryUse use;
  if (origin().use_count() > 1) throw std::logic_error("a file is closed before the objects in it");
  Origin& closing = *origin();
  release();
  if (!closing.broken() && !file_.close()) closing.incomplete = true;
  if (closing.bytes->writable()) closing.bytes->close(flush);
  if (closing.broken()) fail("the rest of its contents");
  return closing.bytes->take_written();
}

}  // namespace zerocount::hdf5
