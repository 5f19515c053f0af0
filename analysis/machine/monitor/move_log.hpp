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

/// Label of a move, by which similar moves are found (Likes).
struct MoveLabel {
  /// Number of the move in the sequence of its trial; nothing if not known.
  std::optional<std::int64_t> number{};
  std::optional<double> target{};  ///< Target position in counts or in SI units; nothing if not known.
  /// Sign of the target minus the preceding target: +1 upwards, −1 downwards; 0 also if it is not known.
  int direction{0};
};

/// The labels of the moves of a log, or of a simulated study.
struct MoveLabels {
  bool numbered{false};            ///< True if moves have their number in a sequence (MoveLabel::number).
  bool targeted{false};            ///< True if moves have targets (MoveLabel::target).
  std::string target_unit{};       ///< Unit of the targets, an SI unit or "count"; empty: not stated.
  double count{0.0};               ///< Size of an encoder count in `si_unit`; 0: not known, as for every log.
  std::string si_unit{};           ///< SI unit of positions on the axis; empty unless `count` is known.
  std::vector<MoveLabel> moves{};  ///< [move] Labels; empty if moves have neither numbers nor targets.

  MoveLabel of(std::size_t move) const { return moves.empty() ? MoveLabel{} : moves[move]; }
};

/// Scale of a measure. It decides how a change of the measure is stated and simulated.
enum class Scale {
  proportion,  ///< Value in [0, 1]: a quality of moves, or a fraction.
  counts,      ///< Whole number, at least 0.
  plain        ///< Any number, such as a time or an error.
};

/// A measure of moves, found in the table of measures by the name of a column.
struct MonitoredMeasure {
  std::string name;  ///< Name as the program writes it: "band_settling_time[1]".
  std::string unit;  ///< Unit in the table of measures: "s".
  /// Row of this measure in the table of measures. All error bands use one row, and all tolerances use
  /// another.
  const layout::Measure* row{nullptr};
  /// True for a yes-or-no measure: 1 for moves with the property, 0 for the others. For the measure
  /// `outcome`, 1 means the outcome zero_count.
  bool quality{false};
  Scale scale{Scale::plain};
  /// True for states of the simulated friction that grow from move to move. Such a measure is watched only if
  /// the settings name it.
  bool accumulates{false};
};

/// The measure with this name, with any error band or tolerance in brackets; nothing if there is none.
/// MonitoredMeasure::name has the number as the program writes it: "band_settling_time[1]" for
/// "band_settling_time[1.0]".
std::optional<MonitoredMeasure> measure_named(std::string_view name);

/// Head of a column, divided into name and unit: "band_settling_time[1]" and "ms" for
/// "band_settling_time[1] [ms]". The unit stands in square or round brackets.
struct ColumnHead {
  std::string name;
  std::string unit;  ///< Unit in the head of the column; empty if the head has none.
};
ColumnHead column_head(std::string_view text);

/// Among `heads`, the head of the column whose name resembles `measure`, for a hint at a misspelling; nothing
/// if none does. Names resemble each other if they have the same letters and digits in any case, if one
/// contains the other, or if they differ in few letters.
/// @param heads heads of the columns, with their units
std::optional<std::string> resembling_column(std::string_view measure, std::span<const std::string> heads);

/// Name of the measure that the column means if its name has another letter case, or other marks between its
/// words: "Arrival-Time [ms]" means arrival_time, and "BandSettlingTime 1" means band_settling_time[1].
/// Nothing if the column means no measure.
std::optional<std::string> misspelt_measure(std::string_view head);

/// Factor that converts a number in the unit to SI units: 0.001 for "mm". It is 1 if the unit is empty or not
/// known to the program.
double si_factor(std::string_view unit);
/// Whether numbers in these two units can be compared after conversion to SI units. An empty unit can be
/// compared with any unit, and a unit that is not known to the program only with itself. Counts can be
/// compared with proportions, because both are plain numbers.
bool have_same_dimension(std::string_view one, std::string_view other);

/// Unit of the measure on a linear axis, where lengths and forces take the place of angles and torques.
std::string linear_unit(const MonitoredMeasure& measure);

/// Whether a column of the measure can have this unit, on a rotary or a linear axis. An empty unit is always
/// possible. A measure with the unit "count" or "1" that is not a proportion has no multiples of its unit,
/// such as percent.
bool can_be_in(const MonitoredMeasure& measure, std::string_view unit);

/// Converts the number in a results file or in a log to the value by which moves are compared and ranked.
/// layout::Missing decides what NaN becomes: an event that never came ranks above any number, and nothing to
/// measure ranks below any number. Some measures are ranked by their magnitude. An `outcome` becomes 1 if it
/// is zero_count, otherwise 0.
double ranked_value(const MonitoredMeasure& measure, double number);
/// Whether a value of ranked_value() means that the move had nothing to measure.
bool is_nothing(const MonitoredMeasure& measure, double ranked);

/// Rank correlation of successive values, in the order of the values: 1 − V/2 with the rank version of von
/// Neumann's ratio V = Σ(r_t − r_{t+1})²/Σ(r_t − r̄)² (Bartels, J. Amer. Statist. Assoc. 77 (1982) 40). It is
/// 0 if all values are equal. Its standard deviation for n independent values is about 1/√n.
double serial_correlation(std::span<const double> values);

/// Typical value of several moves: the upper median or, for a yes-or-no measure, the proportion of moves with
/// a yes.
double typical_value(const MonitoredMeasure& measure, std::vector<double> values);

/// Moves of a machine, or of a simulated study, in their order.
struct Moves {
  struct Column {
    MonitoredMeasure measure;
    std::string unit;  ///< Unit in the header; empty: none.
    /// [move] Values after ranked_value(), in SI units if the column has a unit.
    std::vector<double> values{};
    /// [move] Values as written in the log, with their signs, for the column final_error only; empty for all
    /// others.
    std::vector<double> written{};
  };

  std::string name{};  ///< Name of the file that the moves come from.
  std::vector<Column> columns{};
  std::int64_t moves{0};
  /// Labels of the moves. In a log they are read from the columns `move` and `target`. The direction of a
  /// move is counted from the target in the row before; the first move of a trial (column `trial`) starts at
  /// 0. A cell of `move` that is not a whole number gives no number.
  MoveLabels labels{};
  std::vector<std::string> groups{};  ///< [move] Group of the move; empty if the log is read without groups.
  /// Heads of the columns of a log that are not measures, with their units.
  std::vector<std::string> other_columns{};

  /// Column of the measure with this name; null if there is none.
  const Column* find(std::string_view measure) const;
};

/// A log of moves as text: a header with the names of measures, then one row per move in the order of the
/// moves. The text may be read in pieces as it grows.
///
/// Cells are separated by the first of tab, semicolon and comma that the header contains. Lines that begin
/// with '#' or '%' are skipped. An empty cell or NaN means that an event never came, or that there was
/// nothing to measure (ranked_value()).
///
/// Rows of a log with one column have no separator. In such a log each blank line after the header is a row
/// with an empty cell, also at the end of the log. In a log with several columns, a blank line has too few
/// cells for a row and is skipped.
class MoveLog : public Moves {
 public:
  /// @param file name of the file, for messages
  /// @param group name of the column with the groups: successive rows with the same cell are one group;
  /// empty: no groups
  explicit MoveLog(std::string file, std::string group = {})
      : Moves{.name = std::move(file)}, group_(std::move(group)) {}

  /// Reads the lines of `text` that end with a line feed.
  /// @returns number of characters that were read; the others belong to a line that has not ended
  /// @throws Failure: bad_input for a header without a measure or without the group, with a column twice,
  /// with the ambiguous name settling_time or with a unit that a measure cannot have, and for lines that end
  /// with a carriage return alone; bad_data for a row with another number of cells than the header, with a
  /// value that the measure cannot have or with an empty group
  std::size_t read(std::string_view text);
  /// Reads the last line of the log, which no line feed ends. A line that has only blanks is a row only if
  /// the log has several columns, and tabs separate the cells.
  /// @throws Failure as read()
  void read_last(std::string_view line);
  /// Checks that a header has been read.
  /// @throws Failure (bad_input) if there was none
  void require_header() const;

  bool has_header() const { return !heads_.empty(); }
  const std::vector<std::string>& others() const { return other_columns; }

 private:
  void read_line(std::string_view line);
  void require_line_feeds(std::string_view line) const;
  void read_header(std::string_view line);
  [[noreturn]] void refuse_twice(std::string_view column) const;
  void read_row(std::string_view line);
  /// If the column is one of the labels move, target and trial, stores the index of its cell in label_cells_.
  /// @param cell index of the column
  void note_label(std::size_t cell, const ColumnHead& head);
  void read_labels(const std::vector<std::string_view>& cells);

  /// Index of the cell, in each row of a log, that has the label (move, target, trial) or the group; nothing
  /// if the log lacks this column.
  struct LabelCells {
    std::optional<std::size_t> move{}, target{}, trial{}, group{};
  };

  std::string group_;
  tables::Separator separator_{tables::Separator::comma};
  /// Heads of all columns of the log; empty before the header has been read.
  std::vector<std::string> heads_;
  /// [cell of a row] Index of the cell's measure in `columns`; npos if the column is not a measure.
  std::vector<std::size_t> column_at_;
  LabelCells label_cells_{};
  double target_factor_{1.0};  ///< Factor from the targets of the log to SI units or counts.
  std::string trial_;  ///< Cell of the column `trial` in the row read last; a change begins a new trial.
  std::int64_t line_{0};
};

}  // namespace zerocount::monitor
