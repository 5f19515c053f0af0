#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "results/hdf5/hdf5.hpp"

struct matvar_t;

namespace zerocount::records {

/// True if the file begins as MAT files of version 5 do (MATLAB 5 to 7, `scipy.io.savemat`).
bool is_mat_file(const std::filesystem::path& path);

/// The arrays of real numbers in a MAT file of version 5, with the paths and lengths that they would have in
/// a file of version 7.3: "/machine/current" is the field `current` of the structure `machine`, and the order
/// of the dimensions is reversed (the last dimension of MATLAB comes first). Other variables (text, cells,
/// complex and sparse numbers, arrays of structures) are left out.
class MatFile {
 public:
  /// @throws Failure: bad_data if the file is damaged; machine_failed if it cannot be read.
  explicit MatFile(const std::filesystem::path& path);

  /// The paths of all arrays in the file, in alphabetic order.
  std::vector<std::string> arrays() const;
  /// Lengths of an array along its dimensions, the last dimension of MATLAB first; nothing if the file has no
  /// such array.
  std::optional<std::vector<hdf5::Size>> lengths(const std::string& path) const;
  /// All elements of an array; the index of the last dimension in lengths() varies fastest.
  std::vector<double> values(const std::string& path) const;

 private:
  struct Array {
    std::vector<hdf5::Size> lengths;
    std::vector<double> values;
  };
  void add(const matvar_t& variable, const std::string& folder);

  std::map<std::string, Array> arrays_;
};

}  // namespace zerocount::records
