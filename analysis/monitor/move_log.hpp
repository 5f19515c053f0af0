#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/monitor/monitored_measure.hpp"
#include "analysis/monitor/move_label.hpp"

namespace zerocount::monitor {

/// A log of moves as text: a header with the names of measures, then one row a move in their order. It may be
/// read in pieces, as it grows.
///
/// Cells are separated by the first of tab, semicolon and comma that the header has. Blank lines, which have
/// no separator, and lines that begin with '#' or '%' are skipped. An empty cell, or NaN, is what never
/// happened; so is a blank line between the rows of a log of one column.
class MoveLog {
 public:
  /// @param name in messages @param group name of the column whose rows of one value belong together; none
  explicit MoveLog(std::string name, std::string group = {})
      : name_(std::move(name)), group_(std::move(group)) {}

  struct Column {
    MonitoredMeasure measure;
    std::string unit;               ///< in the header; empty: none
    std::vector<double> values;     ///< [move] as ranked_value() has them, in SI where the column has a unit
    std::vector<double> written{};  ///< [move] of final_error: with their signs
  };

  /// Reads the lines that end in `text`. @returns the number of its characters that were read
  /// @throws Failure: bad_input for a header without a measure, with one twice or in a unit that it cannot
  /// have, or where carriage returns alone end the lines; bad_data for a row of another number of cells, or
  /// with a value that the measure cannot have
  std::size_t read(std::string_view text);
  /// Reads the last line, although nothing ends it.
  void read_last(std::string_view line);
  /// @throws Failure (bad_input) if there was no header
  void require_header() const;

  const std::string& name() const { return name_; }
  bool has_header() const { return !heads_.empty(); }
  const std::vector<Column>& columns() const { return columns_; }
  const Column* find(std::string_view measure) const;
  /// Names of the columns that are not measures, as the header has them.
  const std::vector<std::string>& others() const { return others_; }
  std::int64_t moves() const { return moves_; }
  /// [move] its number in the sequence of a trial, from 0, by the column `move`; −1 where that has no whole
  /// number. Empty without such a column.
  const std::vector<std::int64_t>& numbers() const { return numbers_; }
  /// By the columns `move` and `target`. The target before is that of the row before; a trial (column
  /// `trial`) begins at 0.
  const MoveLabels& labels() const { return labels_; }
  /// [move] the cell of the group. Empty without one.
  const std::vector<std::string>& groups() const { return groups_; }

 private:
  void read_line(std::string_view line);
  void require_line_feeds(std::string_view line) const;
  void read_header(std::string_view line);
  [[noreturn]] void refuse_twice(std::string_view column) const;
  void read_row(std::string_view line);
  /// Remembers the place of a column that is no measure.
  void note_label(std::size_t cell, const ColumnHead& head);
  void read_labels(const std::vector<std::string_view>& cells);

  /// Cells of a row that are no measures.
  struct LabelCells {
    std::optional<std::size_t> move{}, target{}, trial{}, group{};
  };

  std::string name_;
  std::string group_;
  char separator_{','};
  std::vector<std::string> heads_;      ///< of all columns
  std::vector<std::size_t> column_at_;  ///< [cell] its place in columns_; heads_.size() if it has none
  std::vector<Column> columns_;
  std::vector<std::string> others_;
  LabelCells label_cells_{};
  double target_factor_{1.0};  ///< to SI, or counts
  std::string trial_;          ///< of the last row
  std::vector<std::int64_t> numbers_;
  MoveLabels labels_;
  std::vector<std::string> groups_;
  std::int64_t moves_{0};
  std::int64_t line_{0};
  std::int64_t blank_lines_{0};  ///< since the last row, in a log of one column
};

}  // namespace zerocount::monitor
