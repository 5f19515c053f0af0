#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "results/hdf5/foreign_file.hpp"
#include "results/hdf5/hdf5.hpp"

namespace zerocount::hdf5 {

/// True if the file is HDF5, with or without a user block before it (a MAT file of version 7.3 has one of 512
/// bytes); false also for what cannot be read.
bool is_hdf5_with_user_block(const std::filesystem::path& path);

/// A file of another program, open to read arrays of numbers of any type.
class ArrayFile : public File {
 public:
  /// @throws Failure: bad_data if it is damaged; machine_failed if it cannot be read.
  explicit ArrayFile(const std::filesystem::path& path) : File(open_foreign(path)) {}

  /// The paths of all datasets of integers and floating-point numbers, in alphabetic order.
  std::vector<std::string> arrays() const;

  /// Lengths along the dimensions; none if there is no such array.
  std::optional<std::vector<Size>> lengths(const std::string& path) const;

  /// All elements, the last dimension fastest. @throws Failure (bad_data) if they cannot be read.
  std::vector<double> values(const std::string& path) const;

 private:
  Handle open(const std::string& path) const;
};

}  // namespace zerocount::hdf5
