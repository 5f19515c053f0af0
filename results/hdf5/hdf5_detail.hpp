#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include <hdf5.h>
#include <hdf5_hl.h>

#include "results/hdf5/element.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/hdf5/library_use.hpp"
#include "results/storage/byte_file.hpp"

/// Internal declarations of the HDF5 layer; not for its users.
namespace zerocount::hdf5 {

static_assert(std::is_same_v<Id, hid_t> && std::is_same_v<Size, hsize_t> && std::is_same_v<int, herr_t>);

struct Origin {
  std::shared_ptr<storage::ByteFile> bytes;
  bool incomplete{false};  ///< Whether a write operation, or the closing of an object, has failed

  /// Whether a write to the file has failed, so that the HDF5 library must not be called again for this file
  /// (see file_driver.hpp).
  bool broken() const { return bytes->writable() && (incomplete || bytes->failure()); }
};

/// Throws the Failure for the object `path` of an HDF5 file after a failed operation; `problem` describes it.
[[noreturn]] void fail_on(Origin& origin, const std::string& path, std::string_view problem);

/// Takes over the identifier of a new type, dataspace or property list of the HDF5 library; throws the
/// Failure if the library could not create it.
Handle made(Id id, Handle::Close close);
void demand(herr_t status);

/// The HDF5 library's types of a number in the file and in memory; for texts see text_type().
struct NumberTypes {
  Id file;
  Id memory;
};
NumberTypes types_of(Element element);
Handle text_type();

/// Compression level of the deflate filter. The inputs of trials have random digits: higher levels take
/// longer and do not compress them better.
inline constexpr int deflate_level = 1;

/// HDF5 properties for creating a file, group or dataset: the order of creation is recorded, times are not.
/// @param kind property list class of the library.
Handle creation_properties(Id kind);

inline constexpr std::string_view unreadable_values = "its values cannot be read or their checksum is wrong";

/// Checks that the library has all filters through which a dataset is stored.
/// @throws Failure (bad_data) with the filter's name and the remedy if it lacks one.
/// @param file, path name the dataset in the message.
void require_known_filters(Id dataset, const std::string& file, const std::string& path);

/// Size in memory (bytes) of one row of a dataset with these lengths; its first dimension counts the rows.
std::size_t row_size(Element element, std::span<const Size> extent);

/// Calls `work` for each index from 0 to count − 1, several at a time on several threads.
/// @param timeline records the work under the name `name`; null: no record.
void for_each_job(std::size_t count, timeline::Timeline* timeline, std::string_view name,
                  const std::function<void(std::size_t)>& work);

}  // namespace zerocount::hdf5
