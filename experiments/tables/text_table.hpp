#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/failure/failure.hpp"

namespace zerocount::tables {

/// A file with columns of numbers: a text, or an HDF5 file.
class ColumnSource {
 public:
  virtual ~ColumnSource() = default;

  /// Name of the file in messages.
  virtual const std::string& name() const = 0;

  /// Whether the file has the column. It may be given by its name in the header, by its number from 1 ("#2"),
  /// or by its path in an HDF5 file.
  virtual bool has(std::string_view column) const = 0;

  /// List of the columns as text, for messages.
  virtual std::string columns_text() const = 0;

  /// The unit of the column according to the file; empty if the file does not state it.
  virtual std::string unit(std::string_view column) const = 0;

  /// All cells of the column as finite numbers.
  /// @throws Failure (bad_data) that names the cells that are not finite numbers
  virtual std::vector<double> numbers(std::string_view column) const = 0;

  /// [row] whether the cell of the column is `word`; empty if the column does not consist of words.
  virtual std::vector<bool> equals(std::string_view column, std::string_view word) const = 0;

  /// [row] number of the row's line in the file, from 1; empty for a file without lines.
  virtual std::vector<std::size_t> lines() const = 0;
};

/// Character that separates the cells of a line in a table.
enum class Separator {
  comma,
  semicolon,
  tab,
  blanks  ///< one or more blanks or tabs, except inside brackets or quotation marks
};

/// Failure for a text that is not a table, or for an unexpected cell.
class TableFault : public Failure {
 public:
  TableFault(ExitCode code, std::string_view table, std::size_t line, std::string what, std::string expected,
             std::size_t column = 1);

  std::size_t line() const { return line_; }  ///< line of the fault, from 1
  /// Position of the first byte of the fault in its line, from 1.
  std::size_t column() const { return column_; }
  const std::string& found() const { return found_; }
  const std::string& expected() const { return expected_; }

 private:
  std::size_t line_;
  std::size_t column_;
  std::string found_;
  std::string expected_;
};

/// Names of the separators, the values of the option `--separator`, in the order of Separator.
std::vector<std::string> separator_names();

/// The cells of one line of a table, without blanks and quotation marks around them.
std::vector<std::string_view> cells_of(std::string_view line, Separator separator);

/// A table as text: a header with the names of the columns, and rows of cells.
///
/// - The separator is the first of tab, semicolon, comma and blanks that gives the first two lines the same
///   number of cells, at least two. It separates nothing inside quotation marks.
/// - Empty lines are skipped, and lines that begin with '#' or '%'. Titles above the header are skipped too:
///   lines of words whose number of cells differs from that of the header, of the row below it and of the
///   last row.
/// - Rows may end with a separator where the header does not.
/// - A name may be followed by its unit: `torque [N m]`, or `torque (N m)` if the unit is known. A column
///   `torque (…)` with something else is found by `torque`, too, and has that as its unit then. A line of
///   units only, below the header, gives the units of the names without one.
/// - If the first row has numbers only, the comment above it is the header if it has as many cells; otherwise
///   the columns have numbers and no names.
/// - The decimal mark is a point, or a comma where the comma is not the separator.
class TextTable : public ColumnSource {
 public:
  /// Reads a table from a text file.
  /// @param separator separator of the cells; empty: it is detected
  /// @throws Failure: bad_input if the file does not exist or is not such a table; bad_data if a row and the
  ///        header differ in the number of cells; machine_failed if the file cannot be read.
  explicit TextTable(const std::filesystem::path& path, std::optional<Separator> separator = std::nullopt);

  /// Takes a text that has been read already. It may have a single column. A line of units below the header
  /// counts as a row.
  /// @param name name of the text in messages
  /// @param expected phrase for the message about an empty text
  /// @throws TableFault
  TextTable(std::string name, std::string text, std::string_view expected);

  const std::string& name() const override { return name_; }
  bool has(std::string_view column) const override { return find(column) < columns_.size(); }
  std::string columns_text() const override;
  std::string unit(std::string_view column) const override;
  /// All cells of the column as finite numbers.
  /// @throws Failure (bad_data) that lists the cells without a finite number, or if the column has decimal
  ///        points and decimal commas.
  std::vector<double> numbers(std::string_view column) const override;
  std::vector<bool> equals(std::string_view column, std::string_view word) const override;
  std::vector<std::size_t> lines() const override { return lines_; }

  std::size_t rows() const { return lines_.size(); }
  /// Number of the line in the file, from 1, on which the row stands.
  std::size_t line(std::size_t row) const { return lines_[row]; }
  std::size_t columns() const { return columns_.size(); }
  /// Index of the column, from 0; equal to columns() if there is none.
  std::size_t find(std::string_view column) const;
  std::string_view cell(std::size_t row, std::size_t column) const;
  /// The number in the cell of this row and column (both from 0); NaN if the cell is not a number.
  double number(std::size_t row, std::size_t column) const;
  /// Position of the first byte of the cell of this row and column in its line, from 1.
  std::size_t place(std::size_t row, std::size_t column) const;
  std::size_t place_in_header(std::size_t column) const;
  /// Text of the column's header cell: its name with its unit.
  std::string_view header_cell(std::size_t column) const;
  std::size_t header_line() const { return header_line_; }

 private:
  struct Column {
    std::string name;
    std::string unit;
    /// For a column name such as "torque (…)" whose bracket is not a known unit: the part before the bracket.
    std::string before_bracket{};
    std::string in_bracket{};
  };
  struct Line {
    std::string_view text;
    std::size_t number;
  };

  void split(std::optional<Separator> separator, std::size_t min_columns, std::string_view expected);
  void read(const std::vector<Line>& content, std::string_view comment_above, std::size_t min_columns);
  void read_header(const Line& line);
  bool read_units(std::string_view line);
  void add_row(const Line& line);
  std::string_view line_of(std::size_t row) const;
  std::string_view header() const { return std::string_view(text_).substr(header_start_, header_size_); }

  std::string name_;
  std::string text_;
  Separator separator_{Separator::comma};
  std::vector<Column> columns_;
  bool named_{true};
  std::size_t header_line_{1};
  std::size_t header_start_{0};  ///< offset in the text of the file at which the header begins
  std::size_t header_size_{0};
  std::vector<std::size_t> lines_;   ///< [row] number of the row's line in the file, from 1
  std::vector<std::size_t> starts_;  ///< [row] offset in the text at which the row's line begins
};

}  // namespace zerocount::tables
