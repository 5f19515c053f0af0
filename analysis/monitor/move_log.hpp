#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/tables/text_table.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::monitor {

/// What tells a move from others beside its measures.
struct MoveLabel {
  std::optional<std::int64_t> number{};  ///< in the sequence of a trial
  std::optional<double> target{};        ///< counts, or in SI
  int direction{0};                      ///< of the target less the one before; 0: not known
};

/// The labels of the moves of a log, or of a simulated study.
struct MoveLabels {
  bool numbered{false};            ///< whether moves have numbers
  bool targeted{false};            ///< whether moves have targets
  std::string target_unit{};       ///< empty: not stated
  double count{0.0};               ///< size of a count in `si_unit`; 0: not known, as of a log
  std::string si_unit{};           ///< of the axis, where `count` is known
  std::vector<MoveLabel> moves{};  ///< [move]; empty where moves have no labels

  MoveLabel of(std::size_t move) const { return moves.empty() ? MoveLabel{} : moves[move]; }
};

/// How a change of a measure is stated.
enum class Scale {
  proportion,  ///< in [0, 1]: a quality of moves, or a fraction
  counts,      ///< whole numbers, at least 0
  plain        ///< any number
};

/// A measure of moves, by the row of the table of measures that a column is named after.
struct MonitoredMeasure {
  std::string name;  ///< that of the column: "band_settling_time[1]"
  std::string unit;  ///< as the table has it: "s"
  const layout::Measure* row{nullptr};
  bool quality{false};  ///< 1 of moves that have it, 0 of others; an outcome is whether it is zero_count
  Scale scale{Scale::plain};
  /// A state of the simulated friction, which grows from move to move: it is watched only where it is named.
  bool accumulates{false};
};

/// The measure of that name, with any error band or tolerance in brackets; nothing if there is none. Its own
/// name has the number as the program writes it: that of "band_settling_time[1.0]" has [1].
std::optional<MonitoredMeasure> measure_named(std::string_view name);

/// The name in the head of a column without its unit, and the unit: "band_settling_time[1] [ms]".
struct ColumnHead {
  std::string name;
  std::string unit;  ///< empty without one
};
ColumnHead column_head(std::string_view text);

/// The column whose name resembles that of the measure: the same letters and digits in any case, one of the
/// two names within the other, or few letters apart. Nothing if none does.
/// @param heads of the columns, with their units
std::optional<std::string> resembling_column(std::string_view measure, std::span<const std::string> heads);

/// The measure that the column's name stands for in another letter case, or with other marks between its
/// words: arrival_time of "Settling-Time [ms]", and band_settling_time[1] of "BandSettlingTime 1".
std::optional<std::string> misspelt_measure(std::string_view head);

/// Factor from the unit of a column to SI, as far as the program knows units; 1 without one.
double si_factor(std::string_view unit);
/// Whether numbers of one unit can be compared with those of the other, both in SI. Without a unit: yes.
bool have_same_dimension(std::string_view one, std::string_view other);

/// The unit of the measure on a linear axis.
std::string linear_unit(const MonitoredMeasure& measure);

/// Whether a column of the measure can have this unit, on an axis of any kind. What is counted has no
/// multiples of its unit, such as percent. Without a unit: yes.
bool can_be_in(const MonitoredMeasure& measure, std::string_view unit);

/// The value that is ranked, of the number that a results file or a log has. NaN is an event that never came,
/// worse than any number, or nothing to measure (layout::Missing), less than any number.
double ranked_value(const MonitoredMeasure& measure, double number);
/// Whether a ranked value says that there was nothing to measure.
bool is_nothing(const MonitoredMeasure& measure, double ranked);

/// The rank correlation of successive values, 1 − V/2 with the rank version of von Neumann's ratio
/// V = Σ(r_t − r_{t+1})²/Σ(r_t − r̄)² (Bartels, J. Amer. Statist. Assoc. 77 (1982) 40); 0 where all are equal.
/// For n independent values it has about the standard deviation 1/√n.
double serial_correlation(std::span<const double> values);

/// The value that stands for several: the upper median, or of a quality the proportion that have it.
double typical_value(const MonitoredMeasure& measure, std::vector<double> values);

/// Moves of a machine, or of a simulated study, in their order.
struct Moves {
  struct Column {
    MonitoredMeasure measure;
    std::string unit;               ///< in the header; empty: none
    std::vector<double> values{};   ///< [move] as ranked_value() has them, in SI where the column has a unit
    std::vector<double> written{};  ///< [move] of final_error: with their signs
  };

  std::string name{};  ///< of the file
  std::vector<Column> columns{};
  std::int64_t moves{0};
  /// By the columns `move` and `target` of a log. The target before is that of the row before; a trial
  /// (column `trial`) begins at 0. A `move` that is not a whole number is none.
  MoveLabels labels{};
  std::vector<std::string> groups{};  ///< [move] the cell of the group, of a log that is read with one
  /// Heads of the columns of a log that are not measures, with their units.
  std::vector<std::string> other_columns{};

  /// Null if there is none.
  const Column* find(std::string_view measure) const;
};

/// A log of moves as text: a header with the names of measures, then one row a move in their order. It may be
/// read in pieces, as it grows.
///
/// Cells are separated by the first of tab, semicolon and comma that the header has. Lines that begin with
/// '#' or '%' are skipped. An empty cell, or NaN, is what never happened. A row of one column has no
/// separator, so that in a log of one column each blank line after the header is a row with an empty cell,
/// also at the end of the log. In a log of several columns a blank line has too few cells for a row, and is
/// skipped.
class MoveLog : public Moves {
 public:
  /// @param file its name in messages @param group name of the column whose rows of one value belong
  /// together; none
  explicit MoveLog(std::string file, std::string group = {})
      : Moves{.name = std::move(file)}, group_(std::move(group)) {}

  /// Reads the lines that end in `text`. @returns the number of its characters that were read
  /// @throws Failure: bad_input for a header without a measure, with one twice or in a unit that it cannot
  /// have, or where carriage returns alone end the lines; bad_data for a row of another number of cells, or
  /// with a value that the measure cannot have
  std::size_t read(std::string_view text);
  /// Reads the rest after the last line feed. If it has only blanks, it is a row only where tabs separate its
  /// cells.
  void read_last(std::string_view line);
  /// @throws Failure (bad_input) if there was no header
  void require_header() const;

  bool has_header() const { return !heads_.empty(); }
  const std::vector<std::string>& others() const { return other_columns; }

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

  std::string group_;
  tables::Separator separator_{tables::Separator::comma};
  std::vector<std::string> heads_;      ///< of all columns
  std::vector<std::size_t> column_at_;  ///< [cell] its place among the columns; npos if it has none
  LabelCells label_cells_{};
  double target_factor_{1.0};  ///< to SI, or counts
  std::string trial_;          ///< of the last row
  std::int64_t line_{0};
};

}  // namespace zerocount::monitor
