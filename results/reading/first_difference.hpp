#pragma once

#include <optional>
#include <string>
#include <vector>

#include "results/hdf5/hdf5.hpp"

namespace zerocount::reading {

/// A dataset that differs between two results files, and how.
struct DatasetDifference {
  enum class Kind { contents, in_one_file_only, unit };
  std::string path;
  std::string how;  ///< Description of the difference, such as "differs from row 17 on"
  Kind kind{Kind::contents};
};

/// Text of a difference for a message: "/outcome/arrival_time: differs from row 17 on".
std::string text_of(const DatasetDifference& difference);

/// Compares all datasets of two groups or files bit by bit, in the order of the first, but statistics last:
/// sizes, types of elements and every value. Two NaN are equal if their bits are. Attributes, such as when
/// the files were written, are ignored.
/// @return description of the first difference; empty if all is equal.
/// @throws Failure (bad_data) where a dataset cannot be read
std::optional<std::string> first_difference(const hdf5::Group& one, const hdf5::Group& other);

/// All datasets that differ between two groups or files, in the order of first_difference(). The attribute
/// `units` is compared too if both datasets have one.
/// @param tolerance relative tolerance of real numbers; any two NaN are then equal. 0: bits are compared.
/// @throws Failure (bad_data) where a dataset cannot be read
std::vector<DatasetDifference> differences(const hdf5::Group& one, const hdf5::Group& other,
                                           double tolerance = 0.0);

}  // namespace zerocount::reading
