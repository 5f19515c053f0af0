#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount::records {

/// A file with columns of numbers: a TextTable or a DatasetFile.
class ColumnSource {
 public:
  virtual ~ColumnSource() = default;

  /// Name of the file in messages.
  virtual const std::string& name() const = 0;

  /// True if there is such a column, by its name in the header, by its number from 1 ("#2"), or by its path.
  virtual bool has(std::string_view column) const = 0;

  /// The columns, for messages.
  virtual std::string columns_text() const = 0;

  /// The unit of the column according to the file; empty if it says none.
  virtual std::string unit(std::string_view column) const = 0;

  /// The column as finite numbers. @throws Failure (bad_data) that names what is none.
  virtual std::vector<double> numbers(std::string_view column) const = 0;

  /// For each row whether the cell is `word`; empty if the column is not of words.
  virtual std::vector<bool> equals(std::string_view column, std::string_view word) const = 0;

  /// [row] line in the file; empty for a file without lines.
  virtual std::vector<std::size_t> lines() const = 0;
};

}  // namespace zerocount::records
