#pragma once

#include <string>
#include <string_view>
#include <type_traits>

#include <hdf5.h>
#include <hdf5_hl.h>

#include "results/hdf5/element.hpp"
#include "results/hdf5/hdf5.hpp"

/// What the sources of the HDF5 layer share; not for its users.
namespace zerocount::hdf5 {

static_assert(std::is_same_v<Id, hid_t> && std::is_same_v<Size, hsize_t> && std::is_same_v<int, herr_t>);

/// Throws the Failure for the object `path` of a file, after an operation of the library failed (or was found
/// wanting).
[[noreturn]] void fail_on(const Origin& origin, const std::string& path, std::string_view problem);

Id file_type(Element element);  ///< of the numbers; texts have text_type()
Handle text_type();

/// Properties of a new file, group or dataset: creation order tracked, no times.
Handle creation_properties(Id kind);

}  // namespace zerocount::hdf5
