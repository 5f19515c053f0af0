#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount::identification {

/// A table of comma-separated values whose first line names the columns. Empty lines, and lines that begin
/// with
/// '#', are skipped. A name may be followed by its unit in brackets: `torque [N m]`.
class CsvTable {
 public:
  /// @throws Failure: bad_input if the file does not exist or is not such a table; bad_data if a row and the
  /// header differ in the number of cells; machine_failed if the file cannot be read.
  explicit CsvTable(const std::filesystem::path& path);

  const std::string& name() const { return name_; }
  std::size_t rows() const { return lines_.size(); }
  /// Line of a row in the file, from 1.
  std::size_t line(std::size_t row) const { return lines_[row]; }
  std::string columns_text() const;  ///< the names, for messages

  bool has(std::string_view column) const { return find(column) < columns_.size(); }

  /// The unit of the column in the header; empty if it has none.
  const std::string& unit(std::string_view column) const { return columns_[find(column)].unit; }

  /// The column as numbers. @throws Failure (bad_data) that lists the cells without a finite number.
  std::vector<double> numbers(std::string_view column) const;

  /// For each row, whether the cell is `word`.
  std::vector<bool> equals(std::string_view column, std::string_view word) const;

 private:
  struct Column {
    std::string name;
    std::string unit;
  };

  std::size_t find(std::string_view column) const;
  void read_header(std::string_view line);
  void add_row(std::string_view line, std::size_t number);
  std::string_view cell(std::size_t row, std::size_t column) const;

  std::string name_;
  std::string text_;
  std::vector<Column> columns_;
  std::vector<std::size_t> lines_;   ///< [row]
  std::vector<std::size_t> starts_;  ///< [row] offset in the text
};

}  // namespace zerocount::identification
