#pragma once

#include <optional>
#include <string>

#include "results/hdf5/hdf5.hpp"

namespace zerocount::reading {

/// Compares all datasets of two files to the bit, in the order of the first, but statistics last: sizes,
/// types of elements and every value; NaN are equal where their bits are. Attributes, such as when the files
/// were written, are not looked at.
/// @return what differs first, "/outcome/settling_time: differs from row 17 on"; nothing where all is equal
/// @throws Failure (bad_data) where a dataset cannot be read
std::optional<std::string> first_difference(const hdf5::Group& one, const hdf5::Group& other);

}  // namespace zerocount::reading
