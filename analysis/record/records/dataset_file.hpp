#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "analysis/record/records/mat_file.hpp"
#include "experiments/tables/text_table.hpp"
#include "results/hdf5/foreign_file.hpp"

namespace zerocount::records {

/// The datasets of an HDF5 file, or of a MAT file of version 5 to 7.3, as columns. A column is the path of a
/// vector, or PATH#NUMBER: the vector with that number, from 1, of a matrix, along its longer dimension.
class DatasetFile : public tables::ColumnSource {
 public:
  /// @throws Failure: bad_data if the file is damaged; machine_failed if it cannot be read.
  explicit DatasetFile(const std::filesystem::path& path);

  const std::string& name() const override { return name_; }
  bool has(std::string_view column) const override { return find(column).count > 0; }
  std::string columns_text() const override;
  std::string unit(std::string_view) const override { return ""; }
  std::vector<double> numbers(std::string_view column) const override;
  std::vector<bool> equals(std::string_view, std::string_view) const override { return {}; }
  std::vector<std::size_t> lines() const override { return {}; }

 private:
  /// Elements of a dataset that make one column: indices first, first + stride, … of the dataset.
  struct Vector {
    std::string path;
    std::size_t first{0};
    std::size_t stride{1};
    std::size_t count{0};  ///< Number of elements; 0: the file has no such column.
  };
  Vector find(std::string_view column) const;
  std::optional<std::vector<hdf5::Size>> lengths_of(const std::string& path) const;

  std::string name_;
  std::variant<hdf5::ArrayFile, MatFile> file_;
};

}  // namespace zerocount::records
