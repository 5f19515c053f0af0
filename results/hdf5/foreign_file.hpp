#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "results/hdf5/hdf5.hpp"

namespace zerocount::hdf5 {

/// Opens, for reading, an HDF5 file that another program or person may have made. A child process first reads
/// its objects, attributes, texts and the first element of each dataset: the HDF5 library crashes on some
/// files that were damaged on purpose, and then only the child ends. Takes about 20 ms, and 0.15 s for a
/// study with 300 000 design points.
/// @throws Failure: bad_data if the child crashes or takes more than 20 s of processor time, or the file is
/// damaged; machine_failed if no child process can be made, it is killed or takes more than 120 s, or the
/// file cannot be read.
File open_foreign(const std::filesystem::path& path);

/// Whether the file is HDF5, with or without a user block before it (a MAT file of version 7.3 has one of 512
/// bytes). False also if the file cannot be read.
bool is_hdf5_with_user_block(const std::filesystem::path& path);

/// An HDF5 file of another program, open to read arrays of numbers of any type.
class ArrayFile : public File {
 public:
  /// Opens the file.
  /// @throws Failure: bad_data if it is damaged; machine_failed if it cannot be read.
  explicit ArrayFile(const std::filesystem::path& path) : File(open_foreign(path)) {}

  /// The paths of all datasets of integers and floating-point numbers, in alphabetic order.
  std::vector<std::string> arrays() const;

  /// Lengths of the array at `path` along its dimensions; empty if there is no array of numbers at that path.
  std::optional<std::vector<Size>> lengths(const std::string& path) const;

  /// All elements of the array at `path`, the last dimension varying fastest.
  /// @throws Failure (bad_data) if they cannot be read.
  std::vector<double> values(const std::string& path) const;

 private:
  Handle open(const std::string& path) const;
};

}  // namespace zerocount::hdf5
