#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/records/dataset_file.hpp"

namespace zerocount::records {

/// Separator of the cells of a line.
enum class Separator {
  comma,
  semicolon,
  tab,
  blanks  ///< one or more blanks or tabs; those in brackets or quotation marks separate nothing
};

/// Values of `--separator`, in the order of Separator.
std::vector<std::string> separator_names();

/// The cells of a line, without blanks and quotation marks around them.
std::vector<std::string_view> cells_of(std::string_view line, Separator separator);

/// A table as text: a header with the names of the columns, and rows of cells.
///
/// - The separator is the first of tab, semicolon, comma and blanks that gives the first two lines the same
///   number of cells, at least two. It separates nothing inside quotation marks.
/// - Empty lines are skipped, and lines that begin with '#' or '%', and titles above the header: lines of
/// words
///   with another number of cells than the header, the row below it and the last row have.
/// - Rows may end with a separator where the header does not.
/// - A name may be followed by its unit: `torque [N m]`, or `torque (N m)` if the unit is known. A column
///   `torque (…)` with something else is found by `torque`, too, and has that as its unit then. A line of
///   units only, below the header, gives the units of the names without one.
/// - If the first row has numbers only, the comment above it is the header if it has as many cells; otherwise
///   the columns have numbers and no names.
/// - The decimal mark is a point, or a comma where the comma is not the separator.
class TextTable : public ColumnSource {
 public:
  /// @param separator none: detected
  /// @throws Failure: bad_input if the file does not exist or is not such a table; bad_data if a row and the
  /// header differ in the number of cells; machine_failed if the file cannot be read.
  explicit TextTable(const std::filesystem::path& path, std::optional<Separator> separator = std::nullopt);

  const std::string& name() const override { return name_; }
  bool has(std::string_view column) const override { return find(column) < columns_.size(); }
  std::string columns_text() const override;
  std::string unit(std::string_view column) const override;
  /// @throws Failure (bad_data) that lists the cells without a finite number, or if the column has decimal
  /// points and decimal commas.
  std::vector<double> numbers(std::string_view column) const override;
  std::vector<bool> equals(std::string_view column, std::string_view word) const override;
  std::vector<std::size_t> lines() const override { return lines_; }

  std::size_t rows() const { return lines_.size(); }
  /// Line of a row in the file, from 1.
  std::size_t line(std::size_t row) const { return lines_[row]; }

 private:
  struct Column {
    std::string name;
    std::string unit;
    std::string before_bracket{};  ///< of a name that ends with (…), which is not a known unit
    std::string in_bracket{};
  };
  struct Line {
    std::string_view text;
    std::size_t number;
  };

  std::size_t find(std::string_view column) const;
  void read(const std::vector<Line>& content, std::string_view comment_above);
  void read_header(std::string_view line);
  bool read_units(std::string_view line);
  void add_row(const Line& line);
  std::string_view cell(std::size_t row, std::size_t column) const;

  std::string name_;
  std::string text_;
  Separator separator_{Separator::comma};
  std::vector<Column> columns_;
  bool named_{true};
  std::vector<std::size_t> lines_;   ///< [row]
  std::vector<std::size_t> starts_;  ///< [row] offset in the text
};

}  // namespace zerocount::records
