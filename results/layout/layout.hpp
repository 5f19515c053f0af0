#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/trial/outcome.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/features.hpp"
#include "experiments/study/grouping.hpp"
#include "results/hdf5/element.hpp"
#include "results/hdf5/hdf5.hpp"

/// The layout of results files: the one description from which the writer, the reader, the CSV export and the
/// test of the format's documentation (results/datasets.md) all derive.
namespace zerocount::layout {

/// A contiguous range of trials by their global rows: row = point·trials + index, so that the trials of a
/// design point are neighbours.
struct RowRange {
  std::int64_t first{0};
  std::int64_t count{0};

  std::int64_t end() const { return first + count; }
  bool operator==(const RowRange&) const = default;
};

/// Total number of rows in all `ranges`.
inline std::int64_t total_rows(std::span<const RowRange> ranges) {
  std::int64_t rows = 0;
  for (const RowRange& range : ranges) rows += range.count;
  return rows;
}

/// Version of the results file format that this program writes and reads. Files of any other version are
/// refused.
inline constexpr std::int64_t format_version = 5;

/// One value of an enumeration, and the word for it in the attribute `flag_meanings` and in CSV files.
struct FlagMeaning {
  std::int64_t value{0};
  std::string word;
};

/// The possible outcomes of a move, with their numbers and words in files.
std::vector<FlagMeaning> outcome_labels();

/// Description of one dataset (column) of a table in a results file.
struct Column {
  std::string name;       ///< Path of the dataset below the table's group
  std::string unit;       ///< Unit of the values; "1" if dimensionless
  std::string long_name;  ///< Meaning of the values, in one line
  hdf5::Element element{hdf5::Element::float64};
  std::vector<FlagMeaning> flags{};  ///< Values of an enumeration with their words; empty if the column is
                                     /// < not an enumeration
  std::string role{};  ///< Role of a column of the table /point: "axis" (a swept parameter) or "statistic";
                       /// < empty in other tables
};

/// The word for `value` in a column that is an enumeration; the number as text if the enumeration has no such
/// value.
std::string value_text(const Column& column, std::int64_t value);

/// The last dimension of a table's columns, if its HDF5 dimension scale stands in the file's root: error
/// bands or tolerances.
struct RootDimension {
  Column scale;
  std::vector<double> values;  ///< Values of the dimension scale, stored as its element type
};

/// Description of a group of columns in a results file that share their first dimension, with the dimension
/// scales that stand in it.
struct Table {
  std::string group;             ///< Path of the HDF5 group from the file's root
  Column rows;                   ///< Dimension scale of the first dimension, the rows
  std::optional<Column> second;  ///< Dimension scale of the second dimension of all columns; empty if there
                                 /// < is none
  std::vector<Column> columns;
  std::optional<RootDimension> last{};  ///< Dimension of all columns after `rows` and `second`; empty if
                                        /// < there is none
};

/// The values that a column of a results file may have. A file with any other value counts as damaged.
struct ValidValues {
  std::string_view expected{};  ///< Possible values in words; empty if every value is possible
  double low{0.0};              ///< Lowest possible value
  double high{std::numeric_limits<double>::max()};
  bool nan{false};  ///< Whether NaN is possible
};

/// Source of a column's value: a data member of the record, or a function of the record.
template <class Record>
using Member = std::variant<double Record::*, std::int64_t Record::*, int Record::*, bool Record::*,
                            trial::Outcome Record::*, trial::HookMode Record::*, loop::ControlPhase Record::*,
                            double (*)(const Record&)>;

template <class Record>
struct RecordField {
  Column column;
  Member<Record> member;
  ValidValues valid{};
};

struct Measure;
/// The measures of a move (such as its arrival time), in the order of the file (see measure_table.hpp).
using MeasureTable = std::vector<Measure>;
/// The measures of a move that this program has, including those of the error bands and tolerances in
/// `features`.
const MeasureTable& measure_table(const study::StudyFeatures& features = {});

/// Settling times of one move for one tolerance of the position error.
struct ToleranceRecord {
  double settling_time{0.0};        ///< Settling time of the mass that closes the loop, s (entry of
                                    /// < MoveOutcome::tolerance_settling_times)
  double other_settling_time{0.0};  ///< Settling time of the other mass, s (entry of
                                    /// < MoveOutcome::other_tolerance_settling_times)
};

/// A jerk (excursion of the error from zero after arrival), and the trial to which it belongs.
struct JerkRecord : trial::Jerk {
  std::int64_t trial{0};  ///< Global row of the trial: point·trials + index
};

/// One sampling instant of a trial whose samples are kept in the file.
struct TraceRecord : trial::SampleRecord {
  std::int64_t trial{0};  ///< Global row of the trial: point·trials + index
};

/// Descriptions of the columns for all measures of a move that a file with these features has.
std::vector<RecordField<trial::MoveOutcome>> outcome_fields(const study::StudyFeatures& features = {},
                                                            const MeasureTable& measures = measure_table());
/// Descriptions of the columns of outcome_table(): the measures of a move except those of error bands and
/// tolerances.
std::vector<RecordField<trial::MoveOutcome>> move_fields(const study::StudyFeatures& features,
                                                         const MeasureTable& measures);
/// Descriptions of the columns of band_table(), the measures of an error band.
const std::vector<RecordField<trial::BandOutcome>>& band_fields();
const std::vector<RecordField<JerkRecord>>& jerk_fields();
/// Descriptions of the columns of a sample record (/trace). The columns that `features` add come last.
std::vector<RecordField<TraceRecord>> trace_fields(const study::StudyFeatures& features);

/// Descriptions of the columns of tolerance_table(): the settling time for a tolerance and, if the features
/// ask for it, the settling time of the other mass.
std::vector<RecordField<ToleranceRecord>> tolerance_fields(const study::StudyFeatures& features);

/// Name of a statistic of an error band, with the band's limit (counts) in brackets:
/// "band_settling_time_p95[1]".
std::string name_of_band(std::string_view name, std::int64_t band);
/// Name of a statistic of a tolerance of the position error, with the tolerance (rad or m) in brackets:
/// "tolerance_settling_time_p95[1e-08]".
std::string name_of_tolerance(std::string_view name, double tolerance);

/// Whether `name` names a measure or statistic of a tolerance, such as "load_tolerance_settling_time_p95".
/// The tolerance in brackets at its end may be missing.
inline bool is_of_tolerance(std::string_view name) {
  return name.find("tolerance_") != std::string_view::npos;
}

/// A column of statistics, computed when a study is complete: one number per design point, or several where
/// StatisticTable or GroupCounts say so. In files, columns whose names differ only in the error band or
/// tolerance at their end, as in "band_settling_time_p95[1]", are one dataset [point, band].
struct PointColumn {
  std::string name;
  std::string unit;
  std::string long_name;
  std::vector<double> values;  ///< Values, [point]; NaN where a point has no value
};

/// A kind of statistics that have a second dimension beside the design point, such as the torque level.
struct StatisticGroup {
  std::string_view name;       ///< Name of the HDF5 group in the file's root
  std::string_view dimension;  ///< Name of the second dimension, and of its HDF5 dimension scale
  std::string_view meaning;    ///< Meaning of an index of the second dimension, in one line
  std::string_view csv;        ///< Name of the CSV file to which the statistics are exported
};

/// All kinds of statistics with a second dimension that a results file may have.
std::span<const StatisticGroup> statistic_groups();
/// The kind of statistics that have one value per torque level of an open-loop study.
const StatisticGroup& level_group();

/// Statistics with a second dimension beside the design point, such as the torque level.
struct StatisticTable {
  const StatisticGroup* group{nullptr};  ///< Kind of the statistics, an entry of statistic_groups()
  std::int64_t width{1};                 ///< Size of the second dimension, for instance the number of torque
                                         /// < levels
  std::vector<PointColumn> columns;      ///< The statistics; each column has values[point·width + index]
};

/// Counts of trials for the groups of a grouping (for instance the machines) at the design points,
/// [point][group].
struct GroupCounts {
  std::vector<std::vector<std::int64_t>> trials;   ///< Number of trials that were judged; 0 in an open-loop
                                                   /// < study
  std::vector<std::vector<std::int64_t>> success;  ///< Number of trials whose moves all ended with a zero
                                                   /// < count
  /// Number of trials whose moves all meet the goal; empty without a goal
  std::vector<std::vector<std::int64_t>> goal_met{};
  std::vector<PointColumn> statistics{};  ///< Further statistics of the groups; each column has
                                          /// < values[point·groups + group]
};

/// All statistics that a file stores for some consecutive design points of a study.
struct StoredStatistics {
  std::vector<PointColumn> points;
  std::vector<StatisticTable> tables;                ///< Statistics with a second dimension, at most one
                                                     /// < table for each entry of statistic_groups()
  std::map<std::string_view, GroupCounts> groups{};  ///< Counts of trials, by the name of the grouping such
                                                     /// < as "machine" (groupings.hpp)
};

/// Number of angles over one revolution at which a friction parameter's profile is tabulated in a file, if
/// all trials are on one rotor.
inline constexpr std::int64_t profile_angles = 4096;

/// Number of angles at which a friction parameter's profile is tabulated in a file, if every machine has a
/// rotor of its own: the smallest power of two with eight angles in the shortest wavelength of the field,
/// from 64 to profile_angles. With many machines it is halved until there are at most 2²² values, as long as
/// two angles remain in that wavelength.
/// @param harmonics number of harmonics of the profile's series.
std::int64_t profile_angles_of_machine(std::size_t harmonics, std::int64_t machines);

/// Description of the HDF5 dimension scale that numbers the design points.
Column point_scale();
/// Descriptions of the columns that hold the values of drawn input parameters.
std::vector<Column> input_columns(const std::vector<study::InputColumn>& inputs);
Table point_table(const std::vector<study::SweepAxis>& axes, const std::vector<PointColumn>& statistics);
Column statistic_column(const PointColumn& statistic);
/// Description of the table of statistics for each error band or each tolerance: [point, band]. It has no
/// columns yet.
Table limit_statistic_table(RootDimension limits);
Table trial_table(const std::vector<study::InputColumn>& inputs);
Table outcome_table(const study::StudyFeatures& features = {},
                    const MeasureTable& measures = measure_table());
/// Description of the table with the measures of error bands: [trial, move, band].
Table band_table(const trial::ErrorBands& bands);
/// The dimension that counts the error bands, with its HDF5 dimension scale.
RootDimension band_dimension(const trial::ErrorBands& bands);
/// Description of the table with the settling times for tolerances of the position error: [trial, move,
/// tolerance].
Table tolerance_table(const study::StudyFeatures& features);
/// The dimension that counts the tolerances of the position error, with its HDF5 dimension scale.
RootDimension tolerance_dimension(const trial::Tolerances& tolerances);
/// Description of the table of outcomes of a file that holds only the verdicts on the moves.
Table verdict_table();
Table jerk_table();
Table trace_table(const study::StudyFeatures& features);
Table statistic_table(const StatisticGroup& group, const std::vector<PointColumn>& columns);
Table profile_table(const std::string& name, const std::string& unit);
/// Description of the table with the profiles of all machines' rotors: [machine, theta].
/// @param name, unit of the friction parameter.
Table rotor_table(const std::string& name, const std::string& unit);
/// Description of the table that says how many whole and how many real numbers in /sums belong to each design
/// point: [point].
Table sums_table();
/// Description of the table with the whole numbers (the next function: the real numbers) of /sums, point
/// after point.
Table whole_sums_table();
Table real_sums_table();

/// Adapts a table's description to the kind of axis: rotary units and long names become those of a linear
/// axis where needed. Values that a study defines itself (its sweep, inputs and profiles) keep their own
/// units.
Table on_axis(Table table, parameters::AxisKind axis);
/// Adapts a column's unit and long name to the kind of axis, rotary or linear.
PointColumn on_axis(PointColumn column, parameters::AxisKind axis);

/// Name of the column that holds the values of an input parameter in the tables /trial and /machine.
std::string input_column_name(const std::string& parameter);

}  // namespace zerocount::layout
