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
  bool incomplete{false};  ///< A write operation or the closing of an object has failed.

  /// The library must not be called again: see file_driver.hpp.
  bool broken() const { return bytes->writable() && (incomplete || bytes->failure()); }
};

/// Throws the Failure for the object `path` of a file after a failed operation.
[[noreturn]] void fail_on(Origin& origin, const std::string& path, std::string_view problem);

/// Takes the identifier of a new type, dataspace or property list; throws the Failure if the library could
/// not create it.
Handle made(Id id, Handle::Close close);
void demand(herr_t status);

/// Types of the library for numbers; for texts see text_type().
struct NumberTypes {
  Id file;
  Id memory;
};
NumberTypes types_of(Element element);
Handle text_type();

/// Level of deflate. The inputs of trials are random digits: higher levels take longer and do not compress
/// them better.
inline constexpr int deflate_level = 1;

/// Properties of a new file, group or dataset: creation order tracked, no times.
Handle creation_properties(Id kind);

inline constexpr std::string_view unreadable_values = "its values cannot be read or their checksum is wrong";

/// @throws Failure (bad_data) with the filter's name and the remedy if a dataset is stored through a filter
/// that the library does not have. @param file, path name the dataset in the message
void require_known_filters(Id dataset, const std::string& file, const std::string& path);

/// Bytes of a row of a dataset with this extent: its first dimension counts the rows.
std::size_t row_size(Element element, std::span<const Size> extent);

/// Calls `work` for each index below `count`, several at a time; `timeline` gets their spans as `name`.
void for_each_job(std::size_t count, timeline::Timeline* timeline, std::string_view name,
                  const std::function<void(std::size_t)>& work);

}  // namespace zerocount::hdf5
